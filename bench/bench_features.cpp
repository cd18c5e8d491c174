// What each feature of light and filtering costs a whole frame: rows beside a plain one, each with one thing changed.
// Frames are those of bench_frame (a new camera each, nothing kept), by `hybrid` on the pool's threads.
#include <string>

#include "bench/harness.h"
#include "bench/scenes.h"
#include "refraction/renderer.h"

namespace shoal::bench {

namespace {

constexpr std::uint64_t kTriangles = 128'000;
constexpr int kCameras = 32;

struct Feature {
  const char* name;
  Shadows shadows = Shadows::kOff;
  int anisotropy = 1;
  int point_lights = 0;
  bool maps = false;
};
// The plain row is the one that the others are read against.
constexpr Feature kFeatures[] = {
    {"plain"},
    {"shadows_map", Shadows::kMap},
    {"anisotropy_4", Shadows::kOff, 4},
    {"anisotropy_16", Shadows::kOff, 16},
    {"point_lights_4", Shadows::kOff, 1, 4},
    {"point_lights_16", Shadows::kOff, 1, 16},
    {"all_maps", Shadows::kOff, 1, 0, true},
    {"all_maps_anisotropy_16", Shadows::kOff, 16, 0, true},
    {"everything", Shadows::kMap, 16, 4, true},
};

void frame(benchmark::State& state, const RenderScene& scene, const PlacedCamera& camera, const Feature& feature) {
  FrameSettings settings;
  settings.width_px = kWidth, settings.height_px = kHeight;
  settings.threads = pool_threads();
  settings.isa = isa();
  settings.shadows = feature.shadows;
  settings.anisotropy = feature.anisotropy;
  Renderer renderer(scene, settings);
  Frame result;
  std::int64_t k = -3;
  for (; k < 0; ++k) renderer.render(turned_left(camera.camera, k), 0.0, result);
  double shade_ms = 0;
  for (auto _ : state) {
    renderer.render(turned_left(camera.camera, k++ % kCameras), 0.0, result);
    for (const auto& [stage, ms] : result.stages_ms)
      if (stage == "shade") shade_ms += ms;
  }
  state.counters["ms:shade"] = benchmark::Counter(shade_ms, benchmark::Counter::kAvgIterations);
  count_items(state, "pix", double{kWidth} * kHeight, settings.threads);
}

// The scene of a feature; a copy only where it differs from the plain one, and only while its row is measured.
void measure(benchmark::State& state, const RenderScene& plain, std::size_t camera, const Feature& feature) {
  const PlacedCamera& eye = plain.cameras[camera];
  if (feature.point_lights == 0 && !feature.maps) {
    frame(state, plain, eye, feature);
    return;
  }
  RenderScene changed = plain;
  if (feature.maps) add_maps(changed);
  add_point_lights(changed, feature.point_lights);
  frame(state, changed, eye, feature);
}

}  // namespace

void register_benchmarks() {
  // From a low eye, where footprints are long.
  const auto grazing = [](const RenderScene& scene) {
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
      if (scene.cameras[i].name == "grazing") return i;
    return std::size_t{0};
  };
  for (const char* name : {"pool", "box"})
    for (const Feature& f : kFeatures)
      add_pooled(std::string("features/") + name + "/128k/" + f.name, [=](auto& state) {
        const RenderScene& scene = built_in_scene(name, kTriangles);
        measure(state, scene, grazing(scene), f);
      });
}

}  // namespace shoal::bench
