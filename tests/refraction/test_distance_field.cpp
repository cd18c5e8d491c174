// The voxel distance field against brute force in double, and the march through it against the ray tracer's oracle.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "refraction/field/distance_field.h"
#include "refraction/field/point_triangle.h"
#include "oracle_scene.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

// The least distance of many points of a triangle: at most one step of theirs too great, never too small.
double sampled_distance(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  constexpr int kSteps = 64;
  double best = 1e300;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j)
      best = std::min(best, norm_of(p - (a + (b - a) * (i / double{kSteps}) + (c - a) * (j / double{kSteps}))));
  return best;
}

Vec3d plane_frame(const WaterBody& body, Vec3f world) {
  const Vec3d p = as_double(world) - as_double(body.origin);
  return {dot(p, as_double(body.axis_x)), dot(p, as_double(body.normal)), dot(p, as_double(body.axis_z))};
}

// Exact in double, of triangles of any size: the least of plane and edges, regions by barycentrics.
double exact_distance(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d e1 = b - a, e2 = c - a, n = cross(e1, e2), r = p - a;
  const double nn = dot(n, n);
  double best = 1e300;
  if (nn > 0) {
    const double u = dot(cross(r, e2), n) / nn, v = dot(cross(e1, r), n) / nn;
    if (u >= 0 && v >= 0 && u + v <= 1) return std::fabs(dot(r, n)) / std::sqrt(nn);
  }
  for (const auto& [s, e] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
    const Vec3d d = e - s;
    const double dd = dot(d, d), t = dd > 0 ? std::min(std::max(dot(p - s, d) / dd, 0.0), 1.0) : 0.0;
    best = std::min(best, norm_of(p - (s + d * t)));
  }
  return best;
}

}  // namespace

TEST_CASE("distance from a triangle, slivers and points among them", "[refraction]") {
  std::mt19937 random(7);
  const auto draw = [&] { return static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f; };
  for (int i = 0; i < 300; ++i) {
    const Vec3f p{draw(), draw(), draw()}, a{draw(), draw(), draw()};
    Vec3f b{draw(), draw(), draw()}, c{draw(), draw(), draw()};
    if (i % 5 == 1) c = a + (b - a) * 0.5f;  // a line, but for rounding
    if (i % 5 == 2) b = a, c = a;
    if (i % 5 == 3) c = b + (c - b) * 1e-4f;
    const double got = std::sqrt(static_cast<double>(triangle_distance2(p, a, b, c)));
    CAPTURE(i, got);
    const double sampled = sampled_distance(as_double(p), as_double(a), as_double(b), as_double(c));
    CHECK(got < sampled + 4e-6);
    CHECK(got > sampled - 0.06);  // triangles are at most 3.5 long
    CHECK(got == Approx(exact_distance(as_double(p), as_double(a), as_double(b), as_double(c))).margin(4e-6));
  }
}

TEST_CASE("a distance field holds the distances, and who is nearest", "[refraction]") {
  const RenderScene scene = built_in("box", 600);
  const WaterBody& body = scene.waters.front();
  const Geometry& g = scene.geometry;
  ThreadPool one(1), three(3);
  for (const bool below : {true, false}) {
    const DistanceField field = build_distance_field(scene, body, below, 40, three);
    REQUIRE(field.voxel_m > 0);
    CHECK(std::max({field.count_x, field.count_y, field.count_z}) <= 43);
    const DistanceField again = build_distance_field(scene, body, below, 40, one);
    CHECK(field.distance_m == again.distance_m);
    CHECK(field.nearest == again.nearest);

    std::vector<std::array<Vec3d, 3>> corners(g.triangles.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        corners[i][k] = plane_frame(body, g.vertices[g.triangles[i].vertex[k]].position_world);
    double worst_near = 0, worst_far = 0, least = 0;
    for (std::size_t at = 0; at < field.distance_m.size(); at += 7) {
      const int x = static_cast<int>(at) % field.count_x, y = static_cast<int>(at) / field.count_x % field.count_y,
                z = static_cast<int>(at) / field.count_x / field.count_y;
      const double voxel = static_cast<double>(field.voxel_m);
      const Vec3d p{static_cast<double>(field.min_m.x) + (x + 0.5) * voxel,
                    static_cast<double>(field.min_m.y) + (y + 0.5) * voxel,
                    static_cast<double>(field.min_m.z) + (z + 0.5) * voxel};
      double want = 1e300;
      for (const auto& c : corners) {
        const double top = std::max({c[0].y, c[1].y, c[2].y}), bottom = std::min({c[0].y, c[1].y, c[2].y});
        if (below ? bottom > 0.02 : top < -0.02) continue;  // not of this side
        want = std::min(want, exact_distance(p, c[0], c[1], c[2]));
      }
      const double got = static_cast<double>(field.distance_m[at]);
      least = std::min(least, got - want);
      (want <= 1.5 * voxel ? worst_near : worst_far) =
          std::max(want <= 1.5 * voxel ? worst_near : worst_far, (got - want) / voxel);
      const auto& c = corners[static_cast<std::size_t>(field.nearest[at])];
      REQUIRE(exact_distance(p, c[0], c[1], c[2]) == Approx(got).margin(1e-5));
    }
    CAPTURE(below, worst_near, worst_far, least);
    CHECK(worst_near < 1e-4);
    CHECK(worst_far < 0.02);
    CHECK(least > -1e-5);
  }
}

TEST_CASE("distance-field shows what the oracle's rays meet, but for a voxel at edges", "[refraction]") {
  const RenderScene scene = built_in("box", 600);
  const RefractionOracle oracle(scene, true);
  FrameSettings settings;
  settings.method = "distance-field";
  settings.width_px = 96, settings.height_px = 64;
  settings.isa = supported_isas().front();
  settings.shadows = Shadows::kOff;
  settings.aovs = 1u << static_cast<int>(Aov::kHitKind) | 1u << static_cast<int>(Aov::kHitPosition) |
                  1u << static_cast<int>(Aov::kHitId);
  // camera, resolution, and what may be wrong: median and 95 % of the error, share of another object or kind
  struct Case {
    const char* camera;
    const char* resolution;
    double median_m, p95_m, wrong;
  };
  for (const Case& c : {Case{"high", "64", 1e-5, 0.03, 0.03}, Case{"high", "256", 1e-5, 1e-3, 0.015},
                        Case{"under", "128", 1e-5, 0.01, 0.04}}) {
    settings.method_options["resolution"] = c.resolution;
    const auto placed = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                     [&](const PlacedCamera& p) { return p.name == c.camera; });
    Renderer renderer(scene, settings);
    Frame frame;
    renderer.render(placed->camera, 0, frame);
    const AovImage &kind = image_of(frame, Aov::kHitKind), &position = image_of(frame, Aov::kHitPosition),
                   &id = image_of(frame, Aov::kHitId);
    std::vector<double> error_m;
    std::size_t water = 0, wrong = 0;
    const auto object = [&](std::uint32_t triangle) {
      const auto& drawables = scene.geometry.drawables;
      return std::upper_bound(drawables.begin(), drawables.end(), triangle,
                              [](std::uint32_t t, const Drawable& d) { return t < d.first_triangle; }) -
             drawables.begin();
    };
    for (int y = 0; y < settings.height_px; ++y)
      for (int x = 0; x < settings.width_px; ++x) {
        const OraclePixel want = oracle.trace(placed->camera, settings.width_px, settings.height_px, x + 0.5, y + 0.5);
        const std::size_t at = static_cast<std::size_t>(y * settings.width_px + x);
        if (!want.water || want.hit_kind == HitKind::kMirror) continue;
        ++water;
        const bool same = kind.uints[at] == static_cast<std::uint32_t>(want.hit_kind) &&
                          (want.hit_kind != HitKind::kSurface || object(id.uints[at]) == object(want.hit_id));
        wrong += same ? 0 : 1;
        if (same && want.hit_kind == HitKind::kSurface)
          error_m.push_back(norm_of(vector_in(position, at) - want.hit_position));
      }
    REQUIRE(error_m.size() > 80);
    std::sort(error_m.begin(), error_m.end());
    const double median = error_m[error_m.size() / 2], p95 = error_m[error_m.size() * 95 / 100],
                 share = static_cast<double>(wrong) / static_cast<double>(water);
    CAPTURE(c.camera, c.resolution, median, p95, share, water);
    CHECK(median < c.median_m);
    CHECK(p95 < c.p95_m);
    CHECK(share < c.wrong);
    CHECK(frame.method_figures.size() == 2);
  }
}
