// two-phase as a rasterizer: what it says it hits is hit, what it misses is bounded, and it traces no ray.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "refraction/data/edge_map.h"
#include "tests/refraction/double_vector.h"
#include "tests/refraction/oracle_scene.h"

using namespace shoal;
using namespace shoal_test;

namespace {

constexpr int kWidth = 240, kHeight = 136;

FrameSettings settings_of(const std::string& method) {
  FrameSettings s;
  s.method = method;
  s.width_px = kWidth, s.height_px = kHeight;
  s.threads = 2;
  s.isa = supported_isas().front();
  s.shadows = Shadows::kOff;
  for (const Aov aov : {Aov::kWaterMask, Aov::kHitKind, Aov::kHitId, Aov::kHitPosition, Aov::kHitApproximate,
                        Aov::kHitSecondary, Aov::kPosition, Aov::kNormal})
    s.aovs |= 1u << static_cast<int>(aov);
  return s;
}

RenderScene scene_of(const std::string& name, float slope) {
  RenderScene scene = built_in(name, 12000);
  for (WaterBody& body : scene.waters) {
    body.surface.kind = slope > 0.0f ? SurfaceKind::kGradientWaves : SurfaceKind::kFlat;
    body.surface.slope = slope;
    body.surface.seed = 7;
  }
  return scene;
}

Frame draw(const RenderScene& scene, std::size_t camera, const FrameSettings& settings) {
  Frame frame;
  Renderer(scene, settings).render(scene.cameras[camera].camera, 1.0, frame);
  return frame;
}

std::size_t object_of(const Geometry& g, std::uint32_t triangle) {
  if (triangle == kNoTriangle) return g.drawables.size();
  const auto after = std::upper_bound(g.drawables.begin(), g.drawables.end(), triangle,
                                      [](std::uint32_t id, const Drawable& d) { return id < d.first_triangle; });
  return static_cast<std::size_t>(after - g.drawables.begin()) - 1;
}

// The share of the water whose rays cross no secondary interface that shows another object than the reference does, and
// the median distance between the points of the others, metres.
struct Wrong {
  double share = 0, median_m = 0;
};
Wrong compare(const RenderScene& scene, const Frame& reference, const Frame& method) {
  std::size_t water = 0, wrong = 0;
  std::vector<double> distances{0};
  for (std::size_t p = 0; p < std::size_t{kWidth} * kHeight; ++p) {
    const auto number = [&](const Frame& frame, Aov aov) { return image_of(frame, aov).uints[p]; };
    const std::uint32_t kind = number(reference, Aov::kHitKind);
    if (number(reference, Aov::kWaterMask) == 0 || number(reference, Aov::kHitSecondary) != 0) continue;
    ++water;
    const bool other =
        kind != number(method, Aov::kHitKind) || object_of(scene.geometry, number(reference, Aov::kHitId)) !=
                                                     object_of(scene.geometry, number(method, Aov::kHitId));
    wrong += other;
    if (other || kind != static_cast<std::uint32_t>(HitKind::kSurface)) continue;
    const Vec3d off =
        vector_in(image_of(reference, Aov::kHitPosition), p) - vector_in(image_of(method, Aov::kHitPosition), p);
    distances.push_back(std::sqrt(dot(off, off)));
  }
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2),
                   distances.end());
  return {static_cast<double>(wrong) / static_cast<double>(std::max<std::size_t>(water, 1)),
          distances[distances.size() / 2]};
}

// Metres by which a ray misses a triangle, in double; negative on the triangle's far side or behind the origin.
double miss_m(const RenderScene& scene, std::uint32_t triangle, Vec3d origin, Vec3d direction) {
  const Geometry& g = scene.geometry;
  const Geometry::TriangleRecord& t = g.triangles[triangle];
  const Vec3d a = as_double(g.vertices[t.vertex[0]].position_world),
              b = as_double(g.vertices[t.vertex[1]].position_world),
              c = as_double(g.vertices[t.vertex[2]].position_world);
  const Vec3d n = unit_of(cross(b - a, c - a));
  const double toward = dot(direction, n);
  if (std::fabs(toward) < 1e-9) return 1e9;
  const double along = dot(a - origin, n) / toward;
  if (along < 0) return 1e9;
  const Vec3d p = origin + direction * along;
  double outside = 0;
  const Vec3d corners[3] = {a, b, c};
  for (int k = 0; k < 3; ++k) {
    const Vec3d edge = corners[(k + 1) % 3] - corners[k];
    outside = std::max(outside, -dot(cross(edge, p - corners[k]), n) / std::sqrt(dot(edge, edge)));
  }
  return outside;
}

// Snell's law in double: the direction beyond a surface.
Vec3d refracted(Vec3d incident, Vec3d normal, double eta) {
  const double cosine = -dot(incident, normal), k = 1 - eta * eta * (1 - cosine * cosine);
  return incident * eta + normal * (eta * cosine - std::sqrt(k));
}

}  // namespace

TEST_CASE("two-phase: a hit that is not marked approximate is hit, in double", "[refraction]") {
  struct Case {
    const char* scene;
    const char* camera;
    float slope;
  };
  std::size_t exact = 0, approximate = 0;
  for (const Case& c : {Case{"pool", "high", 0.05f}, Case{"pool", "grazing", 0.15f}, Case{"pond", "high", 0.05f},
                        Case{"tank", "oblique", 0.05f}}) {
    const RenderScene scene = scene_of(c.scene, c.slope);
    std::size_t camera = 0;
    while (scene.cameras.at(camera).name != c.camera) ++camera;
    const Frame frame = draw(scene, camera, settings_of("two-phase"));
    const Vec3d eye = as_double(scene.cameras[camera].camera.position_world);
    for (std::size_t p = 0; p < std::size_t{kWidth} * kHeight; ++p) {
      if (image_of(frame, Aov::kHitKind).uints[p] != static_cast<std::uint32_t>(HitKind::kSurface)) continue;
      if (image_of(frame, Aov::kHitApproximate).uints[p] != 0) {
        ++approximate;
        continue;
      }
      const WaterBody& body = scene.waters[image_of(frame, Aov::kWaterMask).uints[p] - 1];
      const Vec3d crossing = vector_in(image_of(frame, Aov::kPosition), p),
                  n = vector_in(image_of(frame, Aov::kNormal), p);
      const Vec3d direction = refracted(unit_of(crossing - eye), unit_of(n), 1 / static_cast<double>(body.ior));
      INFO(c.scene << " " << c.camera << ", pixel " << p % kWidth << ", " << p / kWidth);
      // The buffers hold position and normal in float: 1e-6 of some metres, and of slopes over some metres.
      REQUIRE(miss_m(scene, image_of(frame, Aov::kHitId).uints[p], crossing, direction) < 2e-4);
      ++exact;
    }
  }
  REQUIRE(exact > 30000);
  CHECK(approximate * 20 < exact);
}

TEST_CASE("two-phase: no ray is traced, few triangles are fetched, and little is wrong", "[refraction]") {
  for (const char* name : {"pool", "pond", "tank"})
    for (const float slope : {0.0f, 0.05f, 0.15f}) {
      const RenderScene scene = scene_of(name, slope);
      for (std::size_t camera = 0; camera < scene.cameras.size(); ++camera) {
        const Frame own = draw(scene, camera, settings_of("two-phase"));
        INFO(name << ", slope " << slope << ", camera " << scene.cameras[camera].name);
        CHECK(own.rays.empty());
        CHECK(own.max_fetches <= 64);
        CHECK(own.mean_fetches >= 1);
        FrameSettings settings = settings_of("two-phase");
        settings.reflections = Reflections::kTraced;
        const Frame traced = draw(scene, camera, settings), reference = draw(scene, camera, settings_of("ray-traced"));
        const Wrong wrong = compare(scene, reference, traced);
        // A pixel is five times as wide here as in the figures of decision 13.
        CHECK(wrong.share <= (slope == 0.0f ? 0.002 : slope < 0.1f ? 0.04 : 0.07));
        CHECK(wrong.median_m < 1e-4);
      }
    }
}

TEST_CASE("edge map: a rectangle has the edges that are in it", "[refraction]") {
  const FrameGrid grid = make_frame_grid(300, 200);
  EdgeMap map;
  map.resize(grid);
  std::vector<bool> edges(static_cast<std::size_t>(grid.blocks_x * grid.blocks_y), false);
  std::uint32_t state = 12345;
  const auto random = [&](int below) {
    state = state * 1664525u + 1013904223u;
    return static_cast<int>((state >> 8) % static_cast<std::uint32_t>(below));
  };
  for (int i = 0; i < 12; ++i) edges[static_cast<std::size_t>(random(grid.blocks_x * grid.blocks_y))] = true;
  for (std::size_t region = 0; region < grid.region_count(); ++region) {
    if (region == 3) {
      map.clear(region);
      continue;
    }
    for (int row = 0; row < 16; ++row) {
      std::uint16_t bits = 0;
      for (int i = 0; i < 16; ++i) {
        const int x = static_cast<int>(region) % grid.regions_x * 16 + i,
                  y = static_cast<int>(region) / grid.regions_x * 16 + row;
        if (edges[static_cast<std::size_t>(y * grid.blocks_x + x)]) bits = static_cast<std::uint16_t>(bits | 1u << i);
      }
      map.set(region, row, bits);
    }
  }
  int with = 0;
  for (int i = 0; i < 2000; ++i) {
    const int x0 = random(400) - 50, y0 = random(300) - 50, x1 = x0 + random(120), y1 = y0 + random(120);
    bool expected = false;
    for (int y = std::max(y0, 0); y <= y1; ++y)
      for (int x = std::max(x0, 0); x <= x1; ++x) {
        if (x / 4 >= grid.blocks_x || y / 4 >= grid.blocks_y) continue;
        const bool cleared = y / 64 * grid.regions_x + x / 64 == 3;
        expected = expected || (!cleared && edges[static_cast<std::size_t>(y / 4 * grid.blocks_x + x / 4)]);
      }
    REQUIRE(map.any_within(x0, y0, x1, y1) == expected);
    with += expected;
  }
  REQUIRE(with > 200);
  REQUIRE(with < 1900);
}
