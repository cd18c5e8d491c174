// The broad phase against double precision: positions, paths, bounds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "broad_phase_oracle.h"

namespace {

using namespace shoal;
using namespace shoal_test;

const float kIors[] = {1.0f / 3.0f, 0.75f, 1.01f, 1.333f, 2.4f, 3.0f};

// A tilted, shifted plane with an eye on either side of it, looking anywhere.
struct Setting {
  View view;
  BroadPhase bp;
};
Setting random_setting(Random& random, float ior, bool eye_above, bool tilted, bool orthographic) {
  Vec3f normal = {0, 1, 0};
  if (tilted) normal = normalize(Vec3f{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)});
  const Vec3f origin = {random.in(-3, 3), random.in(-3, 3), random.in(-3, 3)};
  const float height = random.log_in(0.05f, 20.0f);
  const Vec3f eye = origin + normal * (eye_above ? height : -height) +
                    cross(normal, normalize(Vec3f{0.3f, 0.2f, 1.0f})) * random.in(-2, 2);
  const View view = looking(eye, random, orthographic);
  return {view, make_broad_phase(origin, normal, ior, view)};
}

Vec3f random_point(Random& random, const Setting& s) {
  const float reach = 10.0f * s.bp.eye_distance_m;
  const Vec3f p = {random.in(-reach, reach), random.in(-reach, reach), random.in(-reach, reach)};
  return s.bp.plane_origin + p;
}

}  // namespace

TEST_CASE("virtual positions are right for any plane, side and ratio", "[refraction]") {
  Random random(1);
  double worst = 0.0;
  for (const float ior : kIors) {
    for (int k = 0; k < 3000; ++k) {
      const Setting s = random_setting(random, ior, (k & 1) != 0, (k & 2) != 0, (k % 5) == 0);
      const Vec3f p = random_point(random, s);
      const Vec3d got = to_double(virtual_position(s.bp, p)), want = oracle_virtual(s.bp, to_double(p));
      const Vec3d off = got - want;
      const double size = norm(to_double(p)) + norm(to_double(s.bp.eye_world)) + norm(want);
      worst = std::max(worst, norm(off) / size);
    }
  }
  CAPTURE(worst);
  CHECK(worst < 4e-7);
}

TEST_CASE("positions along an axis-aligned plane are kept to the bit, and the eye's side from the thin one",
          "[refraction]") {
  Random random(2);
  for (int k = 0; k < 2000; ++k) {
    const Setting s = random_setting(random, 1.333f, (k & 1) != 0, false, (k % 3) == 0);
    const Vec3f p = random_point(random, s), v = virtual_position(s.bp, p);
    CHECK(v.x == p.x);
    CHECK(v.z == p.z);
    if (s.bp.eye_is_thin && far_distance(s.bp, p) <= 0.0f) CHECK(v.y == p.y);
    const Setting same = random_setting(random, 1.0f, (k & 1) != 0, true, (k % 3) == 0);
    const Vec3f q = virtual_position(same.bp, p);
    CHECK((q.x == p.x && q.y == p.y && q.z == p.z));
    CHECK(edge_deviation_px(same.bp, same.view, p, p * 0.5f) == 0.0f);
  }
}

TEST_CASE("from under water the map goes through the plane without a jump, rising", "[refraction]") {
  Random random(3);
  for (int k = 0; k < 300; ++k) {
    const Setting s = random_setting(random, 1.333f, false, false, false);
    Vec3f p = random_point(random, s);
    const float a = s.bp.eye_distance_m;
    float before = -1e30f;
    for (int i = -50; i <= 50; ++i) {
      p.y = s.bp.plane_origin.y + 1e-3f * a * static_cast<float>(i);
      const float v = virtual_position(s.bp, p).y;
      CAPTURE(k, i, v, before);
      REQUIRE(v >= before - 4e-6f * (std::fabs(v) + a));
      before = v;
    }
    // At the plane: the edge of the window, tan = 1 / sqrt(n^2 - 1), or the plane itself inside of it.
    p.y = s.bp.plane_origin.y;
    const Vec3d foot = to_double(p) - to_double(s.bp.eye_world);
    const double n = static_cast<double>(1.333f), d = std::sqrt(foot.x * foot.x + foot.z * foot.z);
    const double lifted = std::max(0.0, std::sqrt(n * n - 1.0) * d - static_cast<double>(a));
    CHECK(virtual_position(s.bp, p).y - s.bp.plane_origin.y == Approx(lifted).epsilon(2e-5).margin(2e-5 * d));
  }
}

TEST_CASE("an orthographic view sees the far side by one angle, or not at all", "[refraction]") {
  Random random(4);
  int invisible = 0;
  for (int k = 0; k < 500; ++k) {
    const Setting s = random_setting(random, kIors[k % 6], true, true, true);
    const double n_eye = s.bp.eye_below ? static_cast<double>(kIors[k % 6]) : 1.0;
    const double n_far = s.bp.eye_below ? 1.0 : static_cast<double>(kIors[k % 6]);
    const double eye_angle = std::acos(std::fabs(dot(to_double(s.bp.view_direction), to_double(s.bp.normal))));
    const double sine = n_eye / n_far * std::sin(eye_angle);
    if (std::fabs(sine - 1.0) < 1e-5) continue;
    CHECK(s.bp.far_side_visible == (sine < 1.0));
    if (sine < 0.9999)
      CHECK(s.bp.far_scale == Approx(std::tan(std::asin(sine)) / std::tan(eye_angle)).epsilon(1e-3));
    else
      ++invisible;
  }
  CHECK(invisible > 20);
}

TEST_CASE("a point's path bends at the plane by Snell's law", "[refraction]") {
  Random random(5);
  for (int k = 0; k < 4000; ++k) {
    const float ior = kIors[k % 6];
    const Setting s = random_setting(random, ior, (k & 1) != 0, (k & 2) != 0, (k % 7) == 0);
    const Vec3f p = random_point(random, s);
    const PointPath<float> path = point_path(s.bp, p);
    const Vec3d crossing = to_double(path.crossing_world), point = to_double(p), n = to_double(s.bp.far_normal);
    const double far_m = dot(point - to_double(s.bp.plane_origin), n);
    const double size = norm(point) + norm(to_double(s.bp.eye_world)) + 1.0;
    if (far_m <= 0.0) {
      CHECK(path.far_side_m == 0.0f);
      CHECK(path.crossing_world.x == p.x);
      continue;
    }
    if (!s.bp.far_side_visible) continue;
    CAPTURE(k, ior, far_m);
    CHECK(std::fabs(dot(crossing - to_double(s.bp.plane_origin), n)) < 2e-6 * size + 1e-5 * s.bp.orthographic * size);
    Vec3d in = s.bp.orthographic ? to_double(s.bp.view_direction) : crossing - to_double(s.bp.eye_world);
    const Vec3d out = point - crossing;
    if (norm(out) < 0.02 * size || norm(in) < 0.02) continue;
    in = in * (1.0 / norm(in));
    const double n_eye = s.bp.eye_below ? static_cast<double>(ior) : 1.0;
    const double n_far = s.bp.eye_below ? 1.0 : static_cast<double>(ior);
    const double sine_in = norm(in - n * dot(in, n)), sine_out = norm(out - n * dot(out, n)) / norm(out);
    CHECK(n_eye * sine_in == Approx(n_far * sine_out).margin(s.bp.orthographic ? 2e-3 : 4e-4));
    CHECK(path.far_side_m == Approx(norm(out)).epsilon(1e-5));
    if (!s.bp.orthographic) CHECK(path.eye_side_m == Approx(norm(crossing - to_double(s.bp.eye_world))).epsilon(1e-5));
  }
}

TEST_CASE("virtual bounds hold every image of their box", "[refraction]") {
  Random random(6);
  for (int k = 0; k < 3000; ++k) {
    const Setting s = random_setting(random, kIors[k % 6], (k & 1) != 0, (k & 2) != 0, (k % 5) == 0);
    const Vec3f corner = random_point(random, s);
    const float a = s.bp.eye_distance_m;
    const Vec3f extent = {random.log_in(0.001f, 30.0f) * a, random.log_in(0.001f, 30.0f) * a,
                          random.log_in(0.001f, 30.0f) * a};
    Vec3f lo, hi;
    virtual_bounds(s.bp, corner, corner + extent, lo, hi);
    bool inside = true;
    for (int i = 0; i < 60; ++i) {
      const auto at = [&](float from, float size) {
        const float t = random.in(-0.3f, 1.3f);
        return std::min(std::max(from + size * t, from), from + size);
      };
      const float x = at(corner.x, extent.x), y = at(corner.y, extent.y), z = at(corner.z, extent.z);
      const Vec3f v = virtual_position(s.bp, Vec3f{x, y, z});
      inside = inside && v.x >= lo.x && v.x <= hi.x && v.y >= lo.y && v.y <= hi.y && v.z >= lo.z && v.z <= hi.z;
    }
    CAPTURE(k);
    REQUIRE(inside);
  }
}

TEST_CASE("bounds of a box under a level plane are tight", "[refraction]") {
  Random random(7);
  const View view = looking({0, 2, 0}, random, false);
  const BroadPhase bp = make_broad_phase(Vec3f{0, 0, 0}, Vec3f{0, 1, 0}, 1.333f, view);
  Vec3f lo, hi;
  virtual_bounds(bp, {3.0f, -2.0f, -1.0f}, {4.0f, -1.0f, 1.0f}, lo, hi);
  CHECK(lo.x == Approx(3.0f).epsilon(1e-4));
  CHECK(hi.z == Approx(1.0f).epsilon(1e-4));
  const double deepest = oracle_distance(1.333f, true, 2.0, 2.0, 3.0);
  CHECK(lo.y <= -deepest);
  CHECK(lo.y > -1.07 * deepest);
}

TEST_CASE("an edge's deviation does not depend on its direction, and is what double precision finds", "[refraction]") {
  Random random(8);
  for (int k = 0; k < 3000; ++k) {
    const Setting s = random_setting(random, kIors[k % 6], (k & 1) != 0, (k & 2) != 0, (k % 9) == 0);
    const Vec3f a = random_point(random, s);
    const Vec3f direction = {random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)};
    const Vec3f b = a + direction * random.log_in(1e-3f, 3.0f);
    const float there = edge_deviation_px(s.bp, s.view, a, b), back = edge_deviation_px(s.bp, s.view, b, a);
    CAPTURE(k, there, back);
    REQUIRE(as_int(there) == as_int(back));
    const Vec3<WideF> wide_a = broadcast<WideF>(a), wide_b = broadcast<WideF>(b);
    REQUIRE(as_int(extract(edge_deviation_px(s.bp, s.view, wide_a, wide_b), 5)) == as_int(there));
    // The middle's deviation, at its own depth, is never above what the edge reports.
    const Vec3d da = to_double(a), db = to_double(b), middle = (da + db) * 0.5;
    const Vec3d off = oracle_virtual(s.bp, middle) - (oracle_virtual(s.bp, da) + oracle_virtual(s.bp, db)) * 0.5;
    const Vec3d image = oracle_virtual(s.bp, middle) - to_double(s.bp.eye_world);
    const double w = s.bp.orthographic ? 1.0 : dot(to_double(s.view.row_w), image);
    if (w < 0.05) continue;
    const double px = norm(off) * static_cast<double>(s.bp.px_per_unit) / w;
    const double rounding = 4e-6 * (norm(da) + norm(db) + norm(to_double(s.bp.eye_world)));
    REQUIRE(px <= static_cast<double>(there) * 1.00001 + rounding * static_cast<double>(s.bp.px_per_unit) / w);
  }
}

TEST_CASE("the Hessian's bound holds for every ratio", "[refraction]") {
  // Second derivatives of v(b, d) at a = 1 by complex step on the closed first ones, in the variables S and v.
  for (const double n : {1.001, 1.05, 1.2, 1.333, 1.5, 1.8, 2.0, 2.1, 2.4, 3.0}) {
    const double worst = largest_hessian(n);
    CAPTURE(n, worst);
    CHECK(worst <= static_cast<double>(hessian_bound(static_cast<float>(n))));
    CHECK(worst > 0.85 * static_cast<double>(hessian_bound(static_cast<float>(n))));
    if (n == 1.333) CHECK(worst == Approx(0.369).epsilon(0.01));
  }
}

TEST_CASE("a meshlet's bound is above every edge in it", "[refraction]") {
  Random random(9);
  int finite[2] = {0, 0}, close = 0;
  for (int k = 0; k < 4000; ++k) {
    const Setting s = random_setting(random, kIors[k % 6], (k & 1) != 0, (k & 2) != 0, (k % 9) == 0);
    const Vec3f corner = random_point(random, s);
    const float size = random.log_in(0.01f, 3.0f) * s.bp.eye_distance_m;
    const Vec3f top = corner + Vec3f{size, size * random.in(0.1f, 1.0f), size};
    const auto inside = [&] {
      const float x = random.in(corner.x, top.x), y = random.in(corner.y, top.y), z = random.in(corner.z, top.z);
      return Vec3f{x, y, z};
    };
    const Vec3f a = inside(), b = inside();
    const float bound = meshlet_deviation_bound_px(s.bp, s.view, corner, top, length(b - a));
    if (bound > 1e30f) continue;
    ++finite[s.bp.eye_is_thin];
    // The map's own rounding is no deviation.
    const float nearest = std::max(s.view.camera.near_m, 0.1f * s.bp.eye_distance_m);
    const float rounding = 4e-6f * (length(a) + length(b) + length(s.bp.eye_world)) * s.bp.px_per_unit / nearest;
    const float deviation = edge_deviation_px(s.bp, s.view, a, b);
    if (!s.bp.eye_is_thin && deviation > 0.1f * bound) ++close;
    CAPTURE(k, bound, deviation);
    REQUIRE(deviation <= bound * 1.001f + (s.bp.orthographic ? rounding * nearest : rounding));
  }
  CHECK(finite[0] > 1000);
  CHECK(finite[1] > 1000);
  CHECK(close > 50);  // and not so far above that it says nothing
}

TEST_CASE("inside of triangles whose edges all pass, the deviation stays below a quarter of a pixel", "[refraction]") {
  Random random(10);
  for (const bool eye_above : {true, false}) {
    for (const bool through_plane : {false, true}) {
      for (const bool water : {true, false}) {
        double worst = 0.0;
        for (int k = 0; k < 2500; ++k) {
          const float ior = water ? 1.333f : random.in(1.0f, 3.0f);
          worst = std::max(worst, worst_deviation_of_passing_triangle(random, ior, eye_above, through_plane));
        }
        CAPTURE(eye_above, through_plane, water, worst);
        CHECK(worst < static_cast<double>(kInteriorBoundPx));
        CHECK(worst > 0.19);  // triangles are as large as may be: the bound is used
      }
    }
  }
}
