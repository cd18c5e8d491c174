// The reference itself: conservation of light, hit points against rays in double, its options, its counts, its
// determinism.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "blend_scene.h"
#include "oracle_scene.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

FrameSettings traced(int width_px, int height_px) {
  FrameSettings s;
  s.method = "ray-traced";
  s.width_px = width_px, s.height_px = height_px;
  s.isa = supported_isas().front();
  s.threads = 2;
  s.keep_linear = true;
  return s;
}

void set_surface(RenderScene& scene, SurfaceKind kind, float slope, WaterGeometry geometry) {
  for (WaterBody& body : scene.waters) {
    body.surface = SurfaceSettings();
    body.surface.kind = kind;
    body.surface.slope = slope;
    body.surface.geometry = geometry;
    body.surface.filter = WaveFilter::kNone;  // as the oracle sees them
  }
}

Sheet level(float half, float y, Vec4f color) {
  return quad({-half, y, -half}, {-half, y, half}, {half, y, half}, {half, y, -half}, color, false);
}

void add_water(Scene& scene, float size, float depth, float y, Vec3f absorption) {
  Node node;
  node.water = static_cast<std::int32_t>(scene.waters.size());
  node.world_from_local[3].y = y;
  WaterSpec spec;
  spec.has_size = spec.has_depth = true;
  spec.size_x = spec.size_z = size, spec.depth = depth;
  spec.absorption = absorption;
  scene.waters.push_back(spec);
  scene.nodes.push_back(node);
}

// White walls that send white, in a white world, round water that keeps nothing.
RenderScene furnace() {
  const Vec4f white{1, 1, 1, 1};
  std::vector<Sheet> sheets = {level(2, -1, white), level(0.4f, 0.3f, white)};
  for (const float side : {-2.0f, 2.0f}) {
    sheets.push_back(quad({side, -1, -2}, {side, -1, 2}, {side, 0.2f, 2}, {side, 0.2f, -2}, white, false));
    sheets.push_back(quad({-2, -1, side}, {2, -1, side}, {2, 0.2f, side}, {-2, 0.2f, side}, white, false));
  }
  sheets.push_back(quad({-1, -0.5f, -1}, {1, -0.5f, -1}, {1, 0.5f, 0}, {-1, 0.5f, 0}, {1, 1, 1, 0.5f}));
  Scene scene = scene_of(sheets, {1, 1, 1});
  add_water(scene, 4, 1, 0, {0, 0, 0});
  return build_render_scene(scene);
}

// A floor, posts and a roof of several colours, lit by themselves, round two bodies of water, one in the other's sight.
RenderScene towers() {
  std::vector<Sheet> sheets = {level(3, -1.5f, {0.25f, 0.5f, 0.75f, 1}), level(0.7f, 1.25f, {0.75f, 0.25f, 0.5f, 1})};
  for (int i = 0; i < 5; ++i) {
    const float x = -1.5f + 0.7f * static_cast<float>(i), z = 0.4f * static_cast<float>(i % 3) - 0.6f;
    sheets.push_back(quad({x, -1.4f, z}, {x + 0.3f, -1.4f, z + 0.1f}, {x + 0.3f, 0.6f, z + 0.1f}, {x, 0.6f, z},
                          {0.9f - 0.15f * static_cast<float>(i), 0.3f, 0.2f * static_cast<float>(i), 1}, false));
  }
  Scene scene = scene_of(sheets, {0, 0, 0});
  add_water(scene, 5, 0.8f, 0, {0.35f, 0.07f, 0.03f});
  add_water(scene, 4, 0.5f, -1, {0.1f, 0.2f, 0.3f});
  return build_render_scene(scene);
}

const Camera kAbove = camera_at({1.2f, 1.1f, 2.1f}, {0, -0.2f, 0}, 1.0);
const Camera kUnder = camera_at({1.2f, -0.6f, 1.4f}, {0, 0.1f, 0}, 1.2);

float brightest(const Frame& frame) {
  float most = 0;
  for (std::size_t i = 0; i < frame.linear.size(); ++i)
    if (i % 4 != 3) most = std::max(most, frame.linear[i]);
  return most;
}

std::uint64_t rays_of(const Frame& frame, const std::string& kind) {
  for (const auto& [name, count] : frame.rays)
    if (name == kind) return count;
  FAIL("no rays called " << kind);
  return 0;
}
std::uint64_t all_rays(const Frame& frame) {
  std::uint64_t sum = 0;
  for (const auto& [name, count] : frame.rays) sum += count;
  return sum;
}

}  // namespace

TEST_CASE("ray-traced: what is reflected and what goes through are all of the light", "[ray-traced]") {
  RenderScene scene = furnace();
  const WaterGeometry geometry = GENERATE(WaterGeometry::kNormals, WaterGeometry::kDisplaced);
  const SurfaceKind kind = GENERATE(SurfaceKind::kFlat, SurfaceKind::kGradientWaves, SurfaceKind::kGerstner);
  set_surface(scene, kind, 0.2f, geometry);
  for (const char* depth : {"1", "2", "4", "8"})
    for (const Camera& camera : {kAbove, kUnder}) {
      FrameSettings settings = traced(72, 54);
      settings.method_options = {{"depth", depth}};
      const Frame frame = render_scene(scene, camera, settings);
      float worst = 0;
      for (std::size_t i = 0; i < frame.linear.size(); ++i)
        if (i % 4 != 3) worst = std::max(worst, std::fabs(frame.linear[i] - 1.0f));
      CAPTURE(depth, static_cast<int>(kind), static_cast<int>(geometry));
      CHECK(frame.water_pixels > 1000);
      CHECK(worst < 2e-6f);
    }
}

TEST_CASE("ray-traced: hit points under waves are those of rays in double", "[ray-traced]") {
  RenderScene scene = built_in("box", 600);
  const WaterGeometry geometry = GENERATE(WaterGeometry::kNormals, WaterGeometry::kDisplaced);
  const SurfaceKind kind = GENERATE(SurfaceKind::kPerlin, SurfaceKind::kGerstner);
  set_surface(scene, kind, 0.15f, geometry);
  for (WaterBody& body : scene.waters) body.surface.wavelength_m = kind == SurfaceKind::kPerlin ? 0.5f : 0.7f;
  RefractionOracle oracle(scene, true);
  oracle.set_waves(surfaces_at(scene, 1.0));
  constexpr int kWidth = 60, kHeight = 40;
  const double height_bound =
      static_cast<double>(prepare_surface(scene.waters[0].surface, 1.0, plane_extent(scene.waters[0])).height_bound_m);
  for (const PlacedCamera& placed : scene.cameras) {
    FrameSettings settings = traced(kWidth, kHeight);
    settings.aovs = (1u << static_cast<unsigned>(Aov::kCount)) - 1u;
    Frame frame;
    Renderer(scene, settings).render(placed.camera, 1.0, frame);
    int water = 0, agree = 0, bent = 0, again = 0;
    double surface_off = 0, hit_off = 0, height_off = 0, normal_off = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const OraclePixel truth = oracle.trace(placed.camera, kWidth, kHeight, x + 0.5, y + 0.5);
        const std::size_t i = static_cast<std::size_t>(y * kWidth + x);
        const bool wet = image_of(frame, Aov::kWaterMask).uints[i] != 0;
        if (!truth.water || !wet) continue;
        ++water;
        bent += truth.bent;
        again += truth.again;
        if (truth.again) continue;
        // The crossing is off by what rounding does to it, and, displaced, by what the intersection may be.
        const double size = truth.path_m + norm_of(as_double(placed.camera.position_world)) + 1.0;
        const bool moved = geometry == WaterGeometry::kDisplaced;
        const double crossing = (2e-7 * size + (moved ? 2e-5 * height_bound : 0)) / truth.steepness;
        const double off = norm_of(vector_in(image_of(frame, Aov::kPosition), i) - truth.position);
        if (moved && off > 0.01) continue;  // at a crest's edge
        surface_off = std::max(surface_off, off / crossing);
        const Vec3d shown = vector_in(image_of(frame, Aov::kPosition), i);
        height_off =
            std::max(height_off, std::fabs(static_cast<double>(image_of(frame, Aov::kSurfaceHeight).floats[i]) -
                                           oracle.surface_height(0, shown)));
        normal_off = std::max(
            normal_off, norm_of(vector_in(image_of(frame, Aov::kSurfaceNormal), i) - oracle.surface_up(0, shown)));
        if (image_of(frame, Aov::kHitId).uints[i] != truth.hit_id ||
            image_of(frame, Aov::kHitKind).uints[i] != static_cast<std::uint32_t>(truth.hit_kind))
          continue;
        ++agree;
        if (truth.hit_id == kNothing) continue;
        const double bound =
            crossing / truth.hit_steepness + crossing * truth.hit_by_surface + 1e-6 * truth.hit_by_slope;
        hit_off =
            std::max(hit_off, norm_of(vector_in(image_of(frame, Aov::kHitPosition), i) - truth.hit_position) / bound);
      }
    CAPTURE(placed.name, static_cast<int>(geometry), static_cast<int>(kind), water, agree, bent, again);
    CHECK(water > 300);
    CHECK(agree > 0.99 * (water - again));
    CHECK(surface_off < 1);
    CHECK(height_off < 2e-5 * height_bound);
    CHECK(normal_off < 1e-5);
    CHECK(hit_off < 1);
  }
}

TEST_CASE("ray-traced: each depth sees what the last one saw, and more", "[ray-traced]") {
  RenderScene scene = towers();
  set_surface(scene, SurfaceKind::kGradientWaves, 0.1f, WaterGeometry::kDisplaced);
  for (const Camera& camera : {kAbove, kUnder}) {
    Frame last;
    int grown = 0;
    for (int depth = 1; depth <= 8; ++depth) {
      FrameSettings settings = traced(64, 48);
      settings.method_options = {{"depth", std::to_string(depth)}, {"weight", "0"}};
      Frame frame = render_scene(scene, camera, settings);
      if (depth > 1) {
        std::size_t less = 0, more = 0;
        for (std::size_t i = 0; i < frame.linear.size(); ++i) {
          less += frame.linear[i] < last.linear[i] - 1e-6f;
          more += frame.linear[i] > last.linear[i] + 1e-6f;
        }
        CAPTURE(depth);
        CHECK(less == 0);  // what is cut sees a black world
        CHECK(all_rays(frame) >= all_rays(last));
        grown += more > 0;
        if (depth <= 3) CHECK(more > 0);
      }
      last = std::move(frame);
    }
    CHECK(grown >= 3);
    CHECK(rays_of(last, "primary") == 64 * 48);
  }
}

TEST_CASE("ray-traced: rays below the weight are not followed, and bring no more than that", "[ray-traced]") {
  RenderScene scene = towers();
  set_surface(scene, SurfaceKind::kGradientWaves, 0.1f, WaterGeometry::kNormals);
  FrameSettings settings = traced(64, 48);
  const auto with = [&](const char* depth, const char* weight) {
    settings.method_options = {{"depth", depth}, {"weight", weight}};
    return render_scene(scene, kAbove, settings);
  };
  const Frame all = with("4", "0"), most = with("4", "0.05"), none = with("4", "1"), straight = with("1", "0");
  CHECK(all_rays(most) < all_rays(all));
  CHECK(none.linear == straight.linear);
  float worst = 0;
  for (std::size_t i = 0; i < all.linear.size(); ++i)
    worst = std::max(worst, std::fabs(all.linear[i] - most.linear[i]));
  CHECK(worst > 1e-4f);
  // At most eight rays of a pixel can be cut at depth 4; what they would have brought is no brighter than the scene.
  CHECK(worst < 8 * 0.05f * std::max(brightest(all), 1.0f));
  const Frame fine = with("4", "0.0001");
  for (std::size_t i = 0; i < all.linear.size(); ++i) {
    if (std::fabs(all.linear[i] - fine.linear[i]) > 8e-4f) FAIL_CHECK("value " << i);
  }
}

TEST_CASE("ray-traced: reflection alone and refraction alone add up to both", "[ray-traced]") {
  RenderScene scene = towers();
  set_surface(scene, SurfaceKind::kGradientWaves, 0.1f, WaterGeometry::kNormals);
  for (const Camera& camera : {kAbove, kUnder}) {
    FrameSettings settings = traced(64, 48);
    settings.aovs = 1u << static_cast<unsigned>(Aov::kWaterMask);
    const auto with = [&](const char* reflection, const char* refraction) {
      settings.method_options = {
          {"depth", "2"}, {"weight", "0"}, {"reflection", reflection}, {"refraction", refraction}};
      return render_scene(scene, camera, settings);
    };
    const Frame both = with("true", "true"), reflected = with("true", "false"), refracted = with("false", "true"),
                neither = with("false", "false");
    CHECK(rays_of(reflected, "refracted") == 0);
    CHECK(rays_of(refracted, "reflected") == 0);
    CHECK(rays_of(reflected, "reflected") == rays_of(both, "reflected"));
    CHECK(rays_of(refracted, "refracted") == rays_of(both, "refracted"));
    int wrong = 0, seen = 0;
    for (std::size_t i = 0; i < both.linear.size(); ++i) {
      const bool wet = image_of(both, Aov::kWaterMask).uints[i / 4] != 0;
      if (!wet) {
        wrong += both.linear[i] != reflected.linear[i] || both.linear[i] != neither.linear[i];
      } else if (i % 4 != 3) {
        wrong += std::fabs(both.linear[i] - (reflected.linear[i] + refracted.linear[i])) > 1e-6f;
        wrong += neither.linear[i] != 0;
        seen += reflected.linear[i] > 0.01f && refracted.linear[i] > 0.01f;
      }
    }
    CHECK(wrong == 0);
    CHECK(seen > 50);
  }
}

TEST_CASE("ray-traced: rays are counted by kind", "[ray-traced]") {
  // A lit floor under water all over the picture, seen straight from above.
  Scene scene = scene_of({level(20, -1, {0.5f, 0.5f, 0.5f, 1})}, {0.2f, 0.3f, 0.4f});
  scene.materials.materials[0].unlit = false;
  for (MeshPrimitive& p : scene.meshes[0].primitives) p.normals.assign(p.positions.size(), Vec3f{0, 1, 0});
  scene.lights.push_back({{1, 1, 1}, 3});
  Node sun;
  sun.light = 0;
  const float c = 0.8f, s = 0.6f;  // shines down and along -z
  sun.world_from_local = from_rows({1, 0, 0, 0}, {0, s, c, 0}, {0, -c, s, 0});
  scene.nodes.push_back(sun);
  add_water(scene, 30, 1, 0, {0, 0, 0});
  const RenderScene built = build_render_scene(scene);
  const Camera camera = shoal_test::camera_at({0, 3, 0.01f}, {0, 0, 0}, 0.8);
  constexpr std::uint64_t kPixels = 61 * 47;
  FrameSettings settings = traced(61, 47);
  settings.shadows = Shadows::kRays;
  const auto count = [&](const char* depth, Reflections reflections, int spp) {
    settings.method_options = {{"depth", depth}};
    settings.reflections = reflections;
    settings.spp = spp;
    const Frame f = render_scene(built, camera, settings);
    return std::vector<std::uint64_t>{rays_of(f, "primary"), rays_of(f, "reflected"), rays_of(f, "refracted"),
                                      rays_of(f, "shadow")};
  };
  using Counts = std::vector<std::uint64_t>;
  CHECK(count("1", Reflections::kTraced, 1) == Counts{kPixels, 0, 0, 0});
  // Each point on the floor asks twice: up to the surface, and on in the air.
  CHECK(count("2", Reflections::kTraced, 1) == Counts{kPixels, kPixels, kPixels, 2 * kPixels});
  CHECK(count("2", Reflections::kEnvironment, 1) == Counts{kPixels, 0, kPixels, 2 * kPixels});
  CHECK(count("8", Reflections::kTraced, 4) == Counts{4 * kPixels, 4 * kPixels, 4 * kPixels, 8 * kPixels});
  settings.digests = true;  // the sample that they are taken from is none of the picture's
  CHECK(count("8", Reflections::kTraced, 4) == Counts{4 * kPixels, 4 * kPixels, 4 * kPixels, 8 * kPixels});
}

TEST_CASE("ray-traced: many layers of glass, in one plane and one-sided, as the rasterizer has them", "[ray-traced]") {
  std::vector<Sheet> sheets = {level(3, -1.5f, {0.75f, 0.625f, 0.5f, 1})};
  for (int i = 0; i < 27; ++i) {  // more than a round's
    const float y = -1.25f + 0.08f * static_cast<float>(i % 20), a = 0.05f + 0.01f * static_cast<float>(i);
    Sheet sheet = level(1.1f + 0.03f * static_cast<float>(i % 20), y,
                        {static_cast<float>(i % 3) / 2, 0.4f, 0.9f - 0.03f * static_cast<float>(i), a});
    sheet.blended = true, sheet.two_sided = i % 4 != 0;
    sheets.push_back(sheet);
  }
  Scene scene = scene_of(sheets, {0.25f, 0.5f, 0.75f});
  add_water(scene, 5, 1.6f, 0.025f, {0.35f, 0.07f, 0.03f});
  const RenderScene built = build_render_scene(scene);
  for (const Camera& camera : {kAbove, kUnder}) {
    FrameSettings settings = traced(80, 60);
    const Frame truth = render_scene(built, camera, settings);
    settings.method = "hybrid";
    const Frame raster = render_scene(built, camera, settings);
    // But for edges, where the broad phase is a quarter of a pixel off.
    std::size_t off = 0;
    for (std::size_t i = 0; i < truth.linear.size(); i += 4) {
      float worst = 0;
      for (std::size_t k = 0; k < 4; ++k)
        worst = std::max(worst, std::fabs(truth.linear[i + k] - raster.linear[i + k]));
      off += worst > 1e-5f;
    }
    CHECK(off < truth.linear.size() / 4 / 20);
  }
}

TEST_CASE("ray-traced: every byte is the same for any threads, tiles and instruction set", "[ray-traced]") {
  RenderScene scene = built_in("box", 600);
  const WaterGeometry geometry = GENERATE(WaterGeometry::kNormals, WaterGeometry::kDisplaced);
  set_surface(scene, SurfaceKind::kGradientWaves, 0.1f, geometry);
  for (const Camera& camera : {scene.cameras.front().camera, scene.cameras.back().camera}) {
    FrameSettings settings = traced(67, 45);
    settings.shadows = Shadows::kRays;
    settings.digests = true;
    settings.isa = supported_isas().back(), settings.threads = 1;
    const Frame expected = render_scene(scene, camera, settings);
    for (const Isa isa : supported_isas())
      for (const int threads : {1, 2, 7})
        for (const int tile : {16, 64, 256}) {
          if (isa != supported_isas().front() && (threads != 2 || tile != 64)) continue;
          settings.isa = isa, settings.threads = threads, settings.tile_px = tile;
          const Frame got = render_scene(scene, camera, settings);
          CAPTURE(isa_name(isa), threads, tile);
          CHECK(got.digests == expected.digests);
          CHECK(got.linear == expected.linear);
          CHECK(got.rays == expected.rays);
        }
  }
}

TEST_CASE("ray-traced: normals alone and the displaced surface differ in proportion to the waves' height",
          "[ray-traced]") {
  RenderScene scene = built_in("box", 600);
  const auto hits = [&](float amplitude_m, WaterGeometry geometry) {
    for (WaterBody& body : scene.waters) {
      body.surface = SurfaceSettings();
      body.surface.kind = SurfaceKind::kPerlin;
      body.surface.amplitude_m = amplitude_m;
      body.surface.wavelength_m = 0.5f;
      body.surface.octaves = 1;
      body.surface.geometry = geometry;
    }
    FrameSettings settings = traced(96, 64);
    settings.aovs = 1u << static_cast<unsigned>(Aov::kHitPosition) | 1u << static_cast<unsigned>(Aov::kHitId) |
                    1u << static_cast<unsigned>(Aov::kHitKind);
    return render_scene(scene, scene.cameras.front().camera, settings);
  };
  // Mean distance of the points that both see on one triangle.
  const auto apart = [&](float amplitude_m) {
    const Frame plane = hits(amplitude_m, WaterGeometry::kNormals),
                waves = hits(amplitude_m, WaterGeometry::kDisplaced);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < 96 * 64; ++i) {
      if (image_of(plane, Aov::kHitKind).uints[i] != 1 || image_of(waves, Aov::kHitKind).uints[i] != 1) continue;
      if (image_of(plane, Aov::kHitId).uints[i] != image_of(waves, Aov::kHitId).uints[i]) continue;
      sum +=
          norm_of(vector_in(image_of(plane, Aov::kHitPosition), i) - vector_in(image_of(waves, Aov::kHitPosition), i));
      ++count;
    }
    REQUIRE(count > 500);
    return sum / count;
  };
  const double full = apart(0.008f), half = apart(0.004f), quarter = apart(0.002f);
  CAPTURE(full, half, quarter);
  CHECK(full > 1e-3);
  CHECK(full / half == Approx(2).epsilon(0.1));
  CHECK(half / quarter == Approx(2).epsilon(0.1));
}
