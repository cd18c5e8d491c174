// The published broad phases against their papers' formulas in double, by other means.
#include <catch2/catch.hpp>

#include <cmath>

#include "broad_phase_oracle.h"
#include "refraction/broad/fixed_point_map.h"
#include "refraction/broad/path_length_map.h"

using namespace shoal_test;

namespace {

// A plane of any orientation, an eye on one of its sides, and points beyond.
struct Setting {
  View view;
  BroadPhase bp;
  double ior;
};

Setting random_setting(Random& random, bool below, bool orthographic) {
  const float yaw = random.in(0, 6.28f), tilt = random.in(0, 1) < 0.5f ? 0.0f : random.in(-1.5f, 1.5f);
  const Vec3f normal = {std::sin(tilt) * std::cos(yaw), std::cos(tilt), std::sin(tilt) * std::sin(yaw)};
  const Vec3f origin = {random.in(-3, 3), random.in(-3, 3), random.in(-3, 3)};
  const float height = random.log_in(0.1f, 10.0f);
  const float ior = random.in(1.05f, 2.0f);
  View view = looking(origin + normal * (below ? -height : height), random, orthographic);
  if (orthographic) {
    // Steeply down (or up) through the plane, so that its far side shows.
    view.camera.forward_world = normal * (below ? 1.0f : -1.0f);
    view = make_view(view.camera, 640, 360, {0, 0});
  }
  return {view, make_broad_phase(origin, normal, ior, view), static_cast<double>(ior)};
}

Vec3f beyond(Random& random, const BroadPhase& bp, float depth_m) {
  const Vec3f n = bp.normal, other = std::fabs(n.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0};
  const Vec3f u = normalize(cross(n, other)), v = cross(n, u);
  return bp.eye_world + u * random.in(-12, 12) + v * random.in(-12, 12) + bp.far_normal * (bp.eye_distance_m + depth_m);
}

// Liu et al., Algorithm 1: line 7 by bisection, the crossing, and the path's length along the way to it.
Vec3d algorithm_1(const Setting& s, Vec3d vertex) {
  const Vec3d eye = to_double(s.bp.eye_world), down = to_double(s.bp.far_normal);
  const double a = std::fabs(dot(to_double(s.bp.plane_origin) - eye, down));
  const Vec3d to_vertex = vertex - eye;
  const double b = dot(to_vertex, down) - a;
  const Vec3d across = to_vertex - down * dot(to_vertex, down);
  const double d = norm(across), i = s.bp.eye_below ? 1.0 / s.ior : s.ior;
  double lo = 0.0, hi = d;
  for (int step = 0; step < 200; ++step) {
    const double x = 0.5 * (lo + hi);
    const double left = x / std::sqrt(a * a + x * x), right = i * (d - x) / std::sqrt((d - x) * (d - x) + b * b);
    (left < right ? lo : hi) = x;
  }
  const double x = 0.5 * (lo + hi);
  const Vec3d p = eye + down * a + across * (d > 0.0 ? x / d : 0.0);
  const double pathlen = std::sqrt(x * x + a * a) + std::sqrt((d - x) * (d - x) + b * b);
  return eye + (p - eye) * (pathlen / norm(p - eye));
}

// Steel's listing, with |depth| and the scene's index.
double virtual_depth(double horiz_dist, double cam_height, double world_depth, double ior, int steps) {
  const double x = horiz_dist / (world_depth + 3.0 * cam_height);
  double depth_ratio = ior * (x * x + 1.0);
  for (int i = 0; i < steps; ++i) {
    const double oblique = horiz_dist / (world_depth / depth_ratio + cam_height);
    depth_ratio = std::sqrt((std::pow(ior, 2) - 1.0) * std::pow(oblique, 2) + std::pow(ior, 2));
  }
  return world_depth / depth_ratio;
}

// Of the coordinates that a map works with: point, eye, and the exact image, which is far off next to the plane from
// the dense side.
double size_of(const Setting& s, Vec3f p) {
  const Vec3d eye = to_double(s.bp.eye_world), image = to_double(virtual_position(s.bp, p));
  return norm(to_double(p)) + norm(eye) + norm(to_double(p) - eye) + norm(image - eye);
}

}  // namespace

TEST_CASE("liu-2020's map is Algorithm 1: the path's length along the way to its crossing") {
  Random random(7);
  double worst = 0;
  for (int n = 0; n < 20000; ++n) {
    const Setting s = random_setting(random, n % 2 == 1, false);
    // From the dense side the crossing itself is ill determined next to the plane outside of the window.
    const Vec3f p = beyond(random, s.bp, s.bp.eye_below ? random.log_in(0.5f, 20) : random.log_in(0.001f, 20));
    const Vec3d got = to_double(PathLengthMap(s.bp, false).position(p)), expected = algorithm_1(s, to_double(p));
    worst = std::max(worst, norm(got - expected) / size_of(s, p));
  }
  INFO("worst error, of the coordinates' size: " << worst);
  CHECK(worst < 3e-6);
  CHECK(worst > 0.0);
}

TEST_CASE("liu-2020's images lie on the exact ones' view rays, orthographic views too") {
  Random random(8);
  for (int n = 0; n < 5000; ++n) {
    const bool orthographic = n % 3 == 0;
    const Setting s = random_setting(random, n % 2 == 1, orthographic);
    const Vec3f p = beyond(random, s.bp, random.log_in(0.5f, 10));
    const Vec3d exact = to_double(virtual_position(s.bp, p)), image = to_double(PathLengthMap(s.bp, false).position(p));
    const Vec3d forward = to_double(s.view.camera.forward_world), eye = to_double(s.bp.eye_world);
    const Vec3d along = orthographic ? forward : (exact - eye) * (1.0 / norm(exact - eye));
    const Vec3d off = image - exact;
    REQUIRE(norm(off - along * dot(off, along)) < 5e-6 * size_of(s, p));
    // What is beyond the crossing is n times as long.
    const PointPath<float> path = point_path(s.bp, p);
    const double expected = static_cast<double>(path.far_side_m);
    const double got = norm(image - to_double(path.crossing_world));
    REQUIRE(std::fabs(got - expected) < 2e-5 * size_of(s, p));
  }
}

TEST_CASE("liu-2020 as printed: every image is in the vertical plane through the eye that the camera looks along") {
  Random random(9);
  for (int n = 0; n < 2000; ++n) {
    const Setting s = random_setting(random, false, false);
    const Vec3f p = beyond(random, s.bp, random.log_in(0.01f, 10));
    const Vec3d image = to_double(PathLengthMap(s.bp, true).position(p)), eye = to_double(s.bp.eye_world);
    const Vec3d side = cross(to_double(s.bp.far_normal), to_double(s.view.camera.forward_world));
    REQUIRE(std::fabs(dot(image - eye, side)) < 1e-5 * size_of(s, p));
    const PointPath<float> path = point_path(s.bp, p);
    REQUIRE(norm(image - eye) ==
            Approx(static_cast<double>(path.eye_side_m) + static_cast<double>(path.far_side_m)).epsilon(1e-5));
  }
}

TEST_CASE("steel-2024's map is his listing") {
  Random random(10);
  double worst = 0;
  for (int n = 0; n < 20000; ++n) {
    const Setting s = random_setting(random, false, false);
    const int steps = 1 + n % 6;
    const float depth = random.in(0, 1) < 0.2f ? -random.log_in(1e-3f, 0.05f) : random.log_in(1e-3f, 20);
    const Vec3f p = beyond(random, s.bp, depth);
    const Vec3d n_far = to_double(s.bp.far_normal), r = to_double(p) - to_double(s.bp.eye_world);
    const double d = norm(r - n_far * dot(r, n_far)), b = dot(to_double(p) - to_double(s.bp.plane_origin), n_far);
    const double v = virtual_depth(d, static_cast<double>(s.bp.eye_distance_m), std::fabs(b), s.ior, steps);
    const Vec3d expected = to_double(p) + n_far * ((b < 0 ? -v : v) - b);
    const Vec3d got = to_double(FixedPointMap(s.bp, steps).position(p));
    worst = std::max(worst, norm(got - expected) / size_of(s, p));
  }
  INFO("worst error, of the coordinates' size: " << worst);
  CHECK(worst < 2e-6);
}

TEST_CASE("steel-2024's four steps: how far from the exact depth, in the range of a game") {
  // d up to 20 eye heights, 0.02 to 3 of them deep, n = 4/3: relative to the exact depth.
  double worst = 0;
  for (int i = 0; i <= 200; ++i)
    for (int j = 0; j <= 60; ++j) {
      const double d = 0.1 * i, b = 0.02 * std::pow(150.0, j / 60.0);
      const double exact = oracle_distance(1.3333f, true, 1.0, b, d);
      worst = std::max(worst, std::fabs(virtual_depth(d, 1.0, b, 1.3333, 4) / exact - 1.0));
    }
  CHECK(worst < 4e-3);
  CHECK(worst > 2e-3);
}

TEST_CASE("the published maps' bounds hold every image of a box") {
  Random random(11);
  for (int n = 0; n < 4000; ++n) {
    const Setting s = random_setting(random, n % 2 == 1, n % 5 == 0);
    const Vec3f centre = beyond(random, s.bp, random.in(-1, 6));
    const Vec3f half = {random.log_in(1e-3f, 3), random.log_in(1e-3f, 3), random.log_in(1e-3f, 3)};
    const PathLengthMap liu(s.bp, false);
    const FixedPointMap steel(s.bp, 1 + n % 5);
    Vec3f liu_lo, liu_hi, steel_lo, steel_hi;
    liu.bounds(centre - half, centre + half, liu_lo, liu_hi);
    steel.bounds(centre - half, centre + half, steel_lo, steel_hi);
    const auto within = [](Vec3f p, Vec3f lo, Vec3f hi) {
      return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x <= hi.x && p.y <= hi.y && p.z <= hi.z;
    };
    for (int k = 0; k < 20; ++k) {
      const auto at = [&](int bit) { return k < 8 ? ((k >> bit) & 1 ? 1.0f : -1.0f) : random.in(-1, 1); };
      const Vec3f p = centre + Vec3f{half.x * at(0), half.y * at(1), half.z * at(2)};
      REQUIRE(within(liu.position(p), liu_lo, liu_hi));
      REQUIRE(within(steel.position(p), steel_lo, steel_hi));
    }
  }
}
