// scene/: what is done once a scene, not once a frame.
#include "bench/harness.h"
#include "bench/scenes.h"

namespace shoal::bench {

namespace {

const ProceduralScene& pool() {
  for (const ProceduralScene& scene : procedural_scenes())
    if (std::string("pool") == scene.name) return scene;
  return procedural_scenes().front();
}

void generate(benchmark::State& state, std::uint64_t triangles) {
  for (auto _ : state) benchmark::DoNotOptimize(pool().make(triangles));
  count_items(state, "tri", static_cast<double>(triangles));
}

// World space, meshlets, materials: build_ms of `shoal render --json`.
void build(benchmark::State& state, std::uint64_t triangles) {
  const Scene scene = pool().make(triangles);
  std::size_t built = 0;
  for (auto _ : state) built = build_render_scene(scene).geometry.triangles.size();
  count_items(state, "tri", static_cast<double>(built));
}

}  // namespace

void register_benchmarks() {
  for (const SizedScene& size : kPoolSizes) {
    add(std::string("generate/pool/") + size.size, [=](auto& state) {
      generate(state, size.triangles);
    })->Unit(benchmark::kMillisecond);
    add(std::string("build/pool/") + size.size, [=](auto& state) {
      build(state, size.triangles);
    })->Unit(benchmark::kMillisecond);
  }
}

}  // namespace shoal::bench
