// raster/: geometry to bins, bins to visibility, visibility to a textured G-buffer, and the pixel functions one by one.
#include <memory>
#include <vector>

#include "bench/harness.h"
#include "bench/kernels.h"
#include "bench/scenes.h"
#include "bench/stages.h"

namespace shoal::bench {

namespace {

constexpr double kPixels = double{kWidth} * kHeight;
// As many camera positions as a run of `shoal render --repeat` has; then from the first again.
constexpr std::int64_t kCameras = 32;

enum Part { kFrontEnd = 1, kTiles = 2, kVisibility = 3 };

// One or both stages of the direct pass, the camera turning; per triangle of the scene.
void direct_pass(benchmark::State& state, const RenderScene& scene, Part part, int threads) {
  Stages stages(scene, kWidth, kHeight, threads);
  stages.front_end();
  stages.tiles();
  std::int64_t k = 0;
  double in = 0, out = 0;
  for (auto _ : state) {
    if ((part & kFrontEnd) != 0) {
      stages.set_camera(turned_left(first_camera(scene), k++ % kCameras));
      stages.front_end();
    }
    if ((part & kTiles) != 0) stages.tiles();
    in += static_cast<double>(stages.triangles_in());
    out += static_cast<double>(stages.triangles_out());
  }
  const double n = static_cast<double>(state.iterations());
  if (scene.geometry.triangles.size() > 2)
    count_items(state, "tri", static_cast<double>(scene.geometry.triangles.size()), threads);
  if (part == kFrontEnd) count_items(state, "tri_in", in / n, threads);  // of meshlets that are not culled
  if (part == kTiles) count_items(state, "tri_out", out / n, threads);   // those that are binned
  if (part == kVisibility) count_items(state, "pix", kPixels, threads);
  state.counters["tri_out_share"] = out / n / static_cast<double>(scene.geometry.triangles.size());
}

void register_direct_pass() {
  for (const SizedScene& size : kPoolSizes)
    for (const auto& [name, part] : {std::pair{"front_end", kFrontEnd}, {"tiles", kTiles}, {"vis", kVisibility}})
      for (int threads = 1; threads <= pool_threads(); ++threads)
        add_pooled(std::string(name) + "/pool/" + size.size + "/threads:" + std::to_string(threads),
                   [=](auto& state) { direct_pass(state, pool_scene(size.triangles), part, threads); });

  // Setup by itself: whole grids of one kind of triangle. The cameras see all of each.
  struct Grid {
    const char* name;
    int cells;
    float cell_px;
    bool front;
  };
  for (const Grid& grid : {Grid{"culled_back", 512, 2, false},
                           {"culled_between_samples", 512, 0.1f, true},
                           {"surviving_2px", 512, 2, true},
                           {"surviving_8px", 128, 8, true}}) {
    const std::string size = std::to_string(grid.cells * grid.cells * 2);
    const auto scene = std::make_shared<std::unique_ptr<RenderScene>>();
    const auto get = [=]() -> const RenderScene& {
      if (!*scene) *scene = std::make_unique<RenderScene>(make_grid(grid.cells, grid.cell_px, grid.front));
      return **scene;
    };
    add_pooled("front_end/" + std::string(grid.name) + "/" + size,
               [=](auto& s) { direct_pass(s, get(), kFrontEnd, 1); });
    if (grid.front && grid.cell_px > 1)
      add_pooled("tiles/" + std::string(grid.name) + "/" + size, [=](auto& s) { direct_pass(s, get(), kTiles, 1); });
  }
}

// The textured quad, from triangles or from visible ids to three targets.
struct FillCase {
  bool from_triangles;
  int texture_size, threads;
};

template <class Targets>
void fill(benchmark::State& state, const FillCase& c, Targets& targets,
          void (*fill_region)(const VisibleIn&, Targets&, std::size_t)) {
  const RenderScene scene = make_quad(c.texture_size);
  Stages stages(scene, kWidth, kHeight, c.threads);
  stages.front_end();
  stages.tiles();
  const auto fill_frame = [&] {
    const VisibleIn in{stages.scene().shading, stages.view(), stages.direct()};
    stages.for_each_region([&](std::size_t region) { fill_region(in, targets, region); });
  };
  fill_frame();  // the pages of the targets are there when time starts
  for (auto _ : state) {
    if (c.from_triangles) {
      stages.front_end();
      stages.tiles();
    }
    fill_frame();
  }
  count_items(state, "pix", kPixels, c.threads);
}

void fill_float(benchmark::State& state, const FillCase& c) {
  FloatTargets targets;
  const std::size_t slots = make_frame_grid(kWidth, kHeight).pixel_slots();
  for (auto* planes : {&targets.position, &targets.normal, &targets.color})
    for (auto& plane : *planes) plane.resize(slots);
  fill(state, c, targets, raster_kernels(isa()).fill_float);
}

void fill_rgba8(benchmark::State& state, const FillCase& c) {
  Rgba8Targets targets;
  const std::size_t slots = make_frame_grid(kWidth, kHeight).pixel_slots();
  for (auto* plane : {&targets.normal, &targets.color, &targets.material}) plane->resize(slots);
  fill(state, c, targets, raster_kernels(isa()).fill_rgba8);
}

// The 1024 texture (11 MB stored, all levels) is read from beyond the second-level cache, the 256 one (0.7 MB) is not.
void register_fill() {
  for (int threads = 1; threads <= pool_threads(); ++threads) {
    const std::string ending = "/1080p/threads:" + std::to_string(threads);
    add_pooled("vis/quad" + ending, [=](auto& s) {
      const RenderScene scene = make_quad(16);
      direct_pass(s, scene, kVisibility, threads);
    });
    for (const int size : {1024, 256}) {
      const std::string scene = "/quad_texture_" + std::to_string(size);
      const FillCase resolve_only{false, size, threads}, whole{true, size, threads};
      add_pooled("gbuffer_resolve_float" + scene + ending, [=](auto& s) { fill_float(s, resolve_only); });
      add_pooled("gbuffer_fill_float" + scene + ending, [=](auto& s) { fill_float(s, whole); });
      add_pooled("gbuffer_resolve_rgba8" + scene + ending, [=](auto& s) { fill_rgba8(s, resolve_only); });
      add_pooled("gbuffer_fill_rgba8" + scene + ending, [=](auto& s) { fill_rgba8(s, whole); });
    }
  }
}

constexpr std::size_t kBlocks = 1024;
constexpr double kBlockPixelCount = double{kBlocks} * 16;

void resolve(benchmark::State& state) {
  const int distinct = static_cast<int>(state.range(0));
  const RenderScene scene = make_grid(128, 8, true);
  const Stages stages(scene, kWidth, kHeight, 1);
  std::vector<std::int32_t> ids(kBlocks * 16);
  for (std::size_t i = 0; i < ids.size(); ++i)
    ids[i] = static_cast<std::int32_t>(i / 16 * 16 + i % 16 * static_cast<std::size_t>(distinct) / 16);
  float out[16];
  for (auto _ : state) {
    raster_kernels(isa()).resolve(stages.scene().geometry(), stages.view(), ids.data(), kBlocks, out);
    benchmark::DoNotOptimize(out);
  }
  count_items(state, "pix", kBlockPixelCount);
  count_items(state, "block", kBlocks);
}

struct SampleCase {
  const char* name;
  float texels_per_px, spread;
};

void sample_texture(benchmark::State& state, const SampleCase& c) {
  static const Texture texture = make_noise(1024);
  float out[16];
  for (auto _ : state) {
    raster_kernels(isa()).sample(texture, Sampler{}, c.texels_per_px / 1024.0f, c.spread, kBlocks, out);
    benchmark::DoNotOptimize(out);
  }
  count_items(state, "pix", kBlockPixelCount);
  count_items(state, "block", kBlocks);
}

Vec3f random_direction(Random& random) {
  const Vec3f v{random.between(-1, 1), random.between(0.05f, 1), random.between(-1, 1)};
  return normalize(v);
}

void shade_surfaces(benchmark::State& state) {
  const Lighting& lighting = pool_scene(kPoolSizes[0].triangles).lighting;
  AlignedArray<GBufferBlock> blocks(kBlocks);
  Random random;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    GBufferBlock& g = blocks[b] = GBufferBlock{};
    for (int i = 0; i < 16; ++i) {
      const Vec3f n = random_direction(random);
      g.normal_world[0][i] = n.x, g.normal_world[1][i] = n.y, g.normal_world[2][i] = n.z;
      for (auto& channel : g.base_color) channel[i] = random.next();
      g.roughness[i] = random.between(0.2f, 0.9f);
      g.alpha[i] = 1;
    }
  }
  std::vector<float> out(kBlocks * 48);
  for (auto _ : state) {
    raster_kernels(isa()).shade(blocks.data(), lighting, kBlocks, out.data());
    benchmark::ClobberMemory();
  }
  count_items(state, "pix", kBlockPixelCount);
  count_items(state, "block", kBlocks);
}

void sky(benchmark::State& state) {
  const Background& background = pool_scene(kPoolSizes[0].triangles).lighting.background;
  std::vector<float> directions(kBlocks * 48), out(kBlocks * 48);
  Random random;
  for (std::size_t i = 0; i < directions.size(); i += 48)
    for (std::size_t lane = 0; lane < 16; ++lane) {
      const Vec3f d = random_direction(random);
      directions[i + lane] = d.x, directions[i + 16 + lane] = d.y, directions[i + 32 + lane] = d.z;
    }
  for (auto _ : state) {
    raster_kernels(isa()).sky(background, directions.data(), kBlocks, out.data());
    benchmark::ClobberMemory();
  }
  count_items(state, "pix", kBlockPixelCount);
  count_items(state, "block", kBlocks);
}

void encode(benchmark::State& state, bool aces) {
  std::vector<float> linear(kBlocks * 48);
  std::vector<std::uint8_t> out(kBlocks * 48);
  Random random;
  for (float& v : linear) v = random.next();
  for (auto _ : state) {
    raster_kernels(isa()).encode(linear.data(), aces, kBlocks, out.data());
    benchmark::ClobberMemory();
  }
  count_items(state, "pix", kBlockPixelCount);
  count_items(state, "block", kBlocks);
}

}  // namespace

void register_benchmarks() {
  register_direct_pass();
  register_fill();
  add("resolve/distinct", resolve)->Arg(1)->Arg(2)->Arg(4)->Arg(16);
  for (const SampleCase& c :
       {SampleCase{"magnified", 0.5f, 1}, {"lod_0.5", 1.41421356f, 1}, {"lod_0.5_and_1.5", 1.41421356f, 2}})
    add(std::string("sample/") + c.name + "/1024blocks", [=](auto& state) { sample_texture(state, c); });
  add("shade/one_light/1024blocks", shade_surfaces);
  add("sky/gradient_and_sun/1024blocks", sky);
  add("encode/srgb8/1024blocks", [](auto& state) { encode(state, false); });
  add("encode/aces_srgb8/1024blocks", [](auto& state) { encode(state, true); });
}

}  // namespace shoal::bench
