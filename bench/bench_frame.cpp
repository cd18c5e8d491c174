// Whole frames, every method, as `shoal render --repeat` times them: scene in memory, a new camera each, the 8-bit
// picture in memory at the end.
#include <map>

#include "bench/harness.h"
#include "bench/scenes.h"
#include "core/error.h"
#include "refraction/renderer.h"

namespace shoal::bench {

namespace {

constexpr double kPixels = double{kWidth} * kHeight;
constexpr std::int64_t kCameras = 32;

void frame(benchmark::State& state, std::uint64_t triangles, const char* method, int threads) {
  const RenderScene& scene = pool_scene(triangles);
  FrameSettings settings;
  settings.method = method;
  settings.width_px = kWidth, settings.height_px = kHeight;
  settings.threads = threads;
  settings.isa = isa();
  std::unique_ptr<Renderer> made;
  try {
    made = std::make_unique<Renderer>(scene, settings);
  } catch (const NotApplicable&) {
    state.SkipWithError("not applicable to the scene");
    return;
  }
  Renderer& renderer = *made;
  Frame result;
  std::int64_t k = -3;
  for (; k < 0; ++k) renderer.render(turned_left(first_camera(scene), k), 0.0, result);

  std::map<std::string, double> stages_ms;
  double water_pixels = 0;
  for (auto _ : state) {
    renderer.render(turned_left(first_camera(scene), k % kCameras), static_cast<double>(k % kCameras) / 60.0, result);
    ++k;
    for (const auto& [stage, ms] : result.stages_ms) stages_ms[stage] += ms;
    water_pixels += static_cast<double>(result.water_pixels);
  }
  using Counter = benchmark::Counter;
  count_items(state, "tri", static_cast<double>(scene.geometry.triangles.size()), threads);
  count_items(state, "pix", kPixels, threads);
  for (const auto& [stage, ms] : stages_ms) state.counters["ms:" + stage] = Counter(ms, Counter::kAvgIterations);
  state.counters["water_share"] = Counter(water_pixels / kPixels, Counter::kAvgIterations);
  const double cycles_per_ms = clock_hz() * 1e-3 * threads;
  if (water_pixels > 0) state.counters["narrow_cycles/water_pix"] = stages_ms["narrow"] * cycles_per_ms / water_pixels;
  state.counters["shade_cycles/pix"] = Counter(stages_ms["shade"] * cycles_per_ms / kPixels, Counter::kAvgIterations);
}

}  // namespace

void register_benchmarks() {
  for (const SizedScene& size : kPoolSizes)
    for (const MethodInfo& method : method_infos())
      for (int threads = 1; threads <= pool_threads(); ++threads)
        add_pooled(std::string("frame/pool/") + size.size + "/" + method.name + "/threads:" + std::to_string(threads),
                   [=](auto& state) { frame(state, size.triangles, method.name, threads); });
}

}  // namespace shoal::bench
