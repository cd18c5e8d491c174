// Rays at flat water and against a triangle, with their differentials, in double and by finite differences.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "broad_phase_oracle.h"
#include "raster/ray_triangle.h"
#include "water/exact_ray.h"

namespace {

using namespace shoal;
using namespace shoal_test;

struct Ray3d {
  Vec3d origin, direction;
};

Ray3d view_ray(const View& view, double x_px, double y_px) {
  const double dx = x_px - static_cast<double>(view.centre_px.x), dy = y_px - static_cast<double>(view.centre_px.y);
  const Vec3d across = to_double(view.ray_dx) * dx + to_double(view.ray_dy) * dy;
  const Vec3d eye = to_double(view.camera.position_world), forward = to_double(view.camera.forward_world);
  return view.camera.orthographic ? Ray3d{eye + across, forward} : Ray3d{eye, forward + across};
}

struct Water3d {
  Vec3d crossing, refracted, reflected;
  double cos_incident, cos_transmitted;  // NaN where totally reflected
};

// By angles: the tangential part scaled to the refracted sine.
Water3d at_water(const BroadPhase& bp, Ray3d ray) {
  const Vec3d n = to_double(bp.far_normal);
  const double t = dot(to_double(bp.plane_origin) - ray.origin, n) / dot(ray.direction, n);
  const Vec3d d = ray.direction * (1.0 / norm(ray.direction));
  const double c = dot(d, n);
  const Vec3d tangent = d - n * c;
  const double eta = bp.eye_below ? static_cast<double>(bp.path.ior) : 1.0 / static_cast<double>(bp.path.ior);
  const double sine = eta * norm(tangent), cos_t = std::sqrt(1.0 - sine * sine);
  return {ray.origin + ray.direction * t, tangent * eta + n * cos_t, tangent - n * c, c, cos_t};
}

// Central differences in double with one step of Richardson: the derivative by pixel, far below float's rounding.
template <class Function>
auto derivative(Function f, double x) {
  const double h = 1e-3;
  const auto slope = [&](double step) { return (f(x + step) - f(x - step)) * (0.5 / step); };
  return slope(h) * (4.0 / 3.0) - slope(2.0 * h) * (1.0 / 3.0);
}

double relative(Vec3f got, Vec3d want, double floor_size) {
  return norm(to_double(got) - want) / std::max(norm(want), floor_size);
}

struct Scene {
  View view;
  BroadPhase bp;
};
Scene random_scene(Random& random, int k) {
  const Vec3f normal =
      (k & 1) != 0 ? Vec3f{0, 1, 0} : normalize(Vec3f{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)});
  const Vec3f origin = {random.in(-3, 3), random.in(-3, 3), random.in(-3, 3)};
  const float height = random.log_in(0.05f, 20.0f);
  const Vec3f eye = origin + normal * ((k & 2) != 0 ? -height : height);
  const View view = looking(eye, random, k % 5 == 0);
  const float iors[] = {1.333f, 0.75f, 1.5f, 1.0f};
  return {view, make_broad_phase(origin, normal, iors[k % 4], view)};
}

}  // namespace

TEST_CASE("a view ray meets the plane, refracts and reflects as in double", "[refraction]") {
  Random random(21);
  double crossing_error = 0.0, direction_error = 0.0;
  int crossed = 0, total = 0;
  for (int k = 0; k < 20000; ++k) {
    const Scene s = random_scene(random, k);
    const float x = random.in(0, 1920), y = random.in(0, 1080);
    const ExactRay<float> got = exact_ray(s.bp, pixel_ray(s.view, x, y));
    const Ray3d ray = view_ray(s.view, static_cast<double>(x), static_cast<double>(y));
    const Vec3d n = to_double(s.bp.far_normal);
    const double approach = dot(ray.direction, n) / norm(ray.direction);
    const double height = dot(to_double(s.bp.plane_origin) - ray.origin, n);
    CAPTURE(k, x, y);
    if (std::fabs(approach) < 1e-5 || std::fabs(height) < 1e-4) continue;
    REQUIRE(got.crosses == (approach > 0.0 && height > 0.0));
    if (!got.crosses) {
      REQUIRE(got.t == 0.0f);
      continue;
    }
    ++crossed;
    const Water3d want = at_water(s.bp, ray);
    const double size = norm(want.crossing) + norm(ray.origin) + norm(to_double(s.bp.plane_origin));
    crossing_error = std::max(crossing_error, norm(to_double(got.crossing_world) - want.crossing) * approach / size);
    CHECK(relative(got.reflected, want.reflected, 1.0) < 1e-6);
    CHECK(got.cos_incident == Approx(want.cos_incident).margin(1e-6));
    const double eta = s.bp.eye_below ? static_cast<double>(s.bp.path.ior) : 1.0 / static_cast<double>(s.bp.path.ior);
    const double sine = eta * std::sqrt(1.0 - approach * approach);
    if (std::fabs(sine - 1.0) < 1e-5) continue;
    REQUIRE(got.transmitted == (sine < 1.0));
    if (sine >= 1.0) {
      ++total;
      REQUIRE(got.reflectance == 1.0f);
      continue;
    }
    direction_error = std::max(direction_error, norm(to_double(got.refracted) - want.refracted) * want.cos_transmitted);
    const double ci = want.cos_incident, ct = want.cos_transmitted;
    const double rs = (eta * ci - ct) / (eta * ci + ct), rp = (ci - eta * ct) / (ci + eta * ct);
    REQUIRE(got.reflectance == Approx(0.5 * (rs * rs + rp * rp)).margin(4e-6 / ct));
  }
  CAPTURE(crossing_error, direction_error, crossed, total);
  CHECK(crossing_error < 2e-7);
  CHECK(direction_error < 6e-7);
  CHECK(crossed > 5000);
  CHECK(total > 300);
}

TEST_CASE("the refracted ray goes through the point whose virtual position the pixel shows", "[refraction]") {
  // Broad and narrow phase are one physics: a point, its virtual position, the pixel of that, and back by the ray.
  Random random(22);
  int seen = 0;
  for (int k = 0; k < 20000; ++k) {
    const Scene s = random_scene(random, k);
    const float reach = 8.0f * s.bp.eye_distance_m;
    const Vec3f offset = {random.in(-reach, reach), random.in(-reach, reach), random.in(-reach, reach)};
    const Vec3f p = s.bp.plane_origin + offset;
    const float far_m = far_distance(s.bp, p);
    if (far_m < 0.02f * reach || !s.bp.far_side_visible) continue;
    const ClipVertex<float> clip = project(s.view, virtual_position(s.bp, p));
    if (clip.w < 0.05f) continue;
    const float x = clip.x / clip.w + s.view.centre_px.x, y = clip.y / clip.w + s.view.centre_px.y;
    if (!(std::fabs(x) < 4000.0f && std::fabs(y) < 4000.0f)) continue;
    const ExactRay<float> ray = exact_ray(s.bp, pixel_ray(s.view, x, y));
    if (!ray.crosses || !ray.transmitted || ray.cos_transmitted < 0.1f || ray.cos_incident < 0.1f) continue;
    ++seen;
    const Vec3d from = to_double(p) - to_double(ray.crossing_world), d = to_double(ray.refracted);
    const double size = norm(to_double(p)) + norm(to_double(s.bp.eye_world));
    CAPTURE(k, x, y);
    REQUIRE(norm(from - d * dot(from, d)) < 4e-4 * size);
  }
  CHECK(seen > 2000);
}

TEST_CASE("ray differentials at the plane and beyond are derivatives by pixel", "[refraction]") {
  Random random(23);
  double worst = 0.0;
  int checked = 0;
  for (int k = 0; k < 20000; ++k) {
    const Scene s = random_scene(random, k);
    const float xf = random.in(0, 1920), yf = random.in(0, 1080);
    const double x = static_cast<double>(xf), y = static_cast<double>(yf);
    const Ray<float> ray = pixel_ray(s.view, xf, yf);
    const ExactRay<float> hit = exact_ray(s.bp, ray);
    if (!hit.crosses || !hit.transmitted || hit.cos_transmitted < 0.05f || hit.cos_incident < 0.02f) continue;
    ++checked;
    const RayDifferential<float> start = pixel_ray_differential<float>(s.view);
    const RayDifferential<float> crossing = at_crossing(ray, start, hit);
    const RayDifferential<float> refracted = refracted_differential(crossing, hit);
    const RayDifferential<float> reflected = reflected_differential(crossing, hit);
    const auto along_x = [&](auto member) {
      return derivative([&](double at) { return at_water(s.bp, view_ray(s.view, at, y)).*member; }, x);
    };
    const auto along_y = [&](auto member) {
      return derivative([&](double at) { return at_water(s.bp, view_ray(s.view, x, at)).*member; }, y);
    };
    // Orthographic directions do not change: rounding alone is left.
    const double floor_size = 1e-7;
    worst = std::max({worst, relative(refracted.origin_dx, along_x(&Water3d::crossing), floor_size),
                      relative(refracted.origin_dy, along_y(&Water3d::crossing), floor_size),
                      relative(refracted.direction_dx, along_x(&Water3d::refracted), floor_size),
                      relative(refracted.direction_dy, along_y(&Water3d::refracted), floor_size),
                      relative(reflected.direction_dx, along_x(&Water3d::reflected), floor_size),
                      relative(reflected.direction_dy, along_y(&Water3d::reflected), floor_size)});
  }
  CAPTURE(worst, checked);
  CHECK(worst < 6e-5);
  CHECK(checked > 3000);
}

TEST_CASE("nothing is NaN next to the critical angle, along the plane, or away from it", "[refraction]") {
  Random random(24);
  Camera camera;
  camera.position_world = {0, -1, 0};
  const View view = make_view(camera, 64, 64, {0, 0});
  const BroadPhase bp = make_broad_phase(Vec3f{0, 0, 0}, Vec3f{0, 1, 0}, 1.333f, view);
  const double critical = std::asin(1.0 / static_cast<double>(1.333f));
  const RayDifferential<float> start = pixel_ray_differential<float>(view);
  for (int i = -50; i <= 50; ++i) {
    const double angle = i == 0 ? 1.5707963267948966 : critical + 1e-8 * i * i * i;
    const Ray<float> ray = {{0, -1, 0}, {static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle)), 0}};
    const Ray<float> along = {ray.origin_world, {1, 0, 0}}, away = {ray.origin_world, {0, -1, 0}};
    for (const Ray<float>& r : {ray, along, away}) {
      const ExactRay<float> hit = exact_ray(bp, r);
      const RayDifferential<float> beyond = refracted_differential(at_crossing(r, start, hit), hit);
      for (const Vec3f& v : {hit.crossing_world, hit.refracted, hit.reflected, beyond.origin_dx, beyond.direction_dy}) {
        CHECK((std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)));
      }
      CHECK((hit.reflectance >= 0.0f && hit.reflectance <= 1.0f));
    }
  }
}

TEST_CASE("ray against triangle, and its screen derivatives", "[refraction]") {
  Random random(25);
  double point_error = 0.0, barycentric_error = 0.0, slope_error = 0.0;
  int checked = 0;
  for (int k = 0; k < 30000; ++k) {
    const Scene s = random_scene(random, k);
    const float xf = random.in(0, 1920), yf = random.in(0, 1080);
    const Ray<float> ray = pixel_ray(s.view, xf, yf);
    const RayDifferential<float> start = pixel_ray_differential<float>(s.view);
    // A triangle somewhere along the ray, of any size and turn.
    const float t = random.log_in(0.1f, 100.0f), size = random.log_in(0.01f, 3.0f);
    const auto offset = [&] {
      const float x = random.in(-1, 1), y = random.in(-1, 1), z = random.in(-1, 1);
      return Vec3f{x, y, z} * size;
    };
    const Vec3f p0 = ray.origin_world + ray.direction_world * t + offset(), e1 = offset(), e2 = offset();
    const Vec3d normal = cross(to_double(e1), to_double(e2));
    const auto exact = [&](Ray3d r) {
      // Plane first, barycentrics by areas: not the code's determinants.
      const Vec3d from = to_double(p0) - r.origin;
      const double at = dot(from, normal) / dot(r.direction, normal);
      const Vec3d in_plane = r.direction * at - from;
      const double area2 = dot(normal, normal);
      return Vec3d{at, dot(cross(in_plane, to_double(e2)), normal) / area2,
                   dot(cross(to_double(e1), in_plane), normal) / area2};
    };
    const double x = static_cast<double>(xf), y = static_cast<double>(yf);
    const Ray3d ray_d = view_ray(s.view, x, y);
    const double e1_m = norm(to_double(e1)), e2_m = norm(to_double(e2));
    const double sharpness = norm(normal) / (e1_m * e2_m);
    const double facing = std::fabs(dot(normal, ray_d.direction)) / (norm(normal) * norm(ray_d.direction));
    const TriangleHit<float> hit = intersect_triangle(ray, p0, e1, e2);
    if (facing < 0.02 || sharpness < 0.05) continue;
    const Vec3d want = exact(ray_d);
    if (std::fabs(want.y) > 5.0 || std::fabs(want.z) > 5.0) continue;
    ++checked;
    REQUIRE(hit.valid);
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
    const Vec3d got = to_double(p0) + to_double(e1) * u + to_double(e2) * v;
    const Vec3d truth = ray_d.origin + ray_d.direction * want.x;
    const double scale = norm(to_double(p0) - ray_d.origin) + norm(ray_d.origin) + e1_m + e2_m;
    point_error = std::max(point_error, norm(got - truth) * facing * sharpness / scale);
    const double uv_error = std::max(std::fabs(u - want.y) * e1_m, std::fabs(v - want.z) * e2_m);
    barycentric_error = std::max(barycentric_error, uv_error * facing * sharpness / scale);
    if (k % 4 != 0) continue;
    const TriangleHitDerivatives<float> slope = hit_derivatives(ray, start, p0, e1, e2, hit);
    const Vec3d by_x = derivative([&](double at) { return exact(view_ray(s.view, at, y)); }, x);
    const Vec3d by_y = derivative([&](double at) { return exact(view_ray(s.view, x, at)); }, y);
    const double largest = std::max({std::fabs(by_x.y), std::fabs(by_x.z), std::fabs(by_y.y), std::fabs(by_y.z)});
    const double off = std::max(
        {std::fabs(static_cast<double>(slope.u_dx) - by_x.y), std::fabs(static_cast<double>(slope.v_dx) - by_x.z),
         std::fabs(static_cast<double>(slope.u_dy) - by_y.y), std::fabs(static_cast<double>(slope.v_dy) - by_y.z)});
    slope_error = std::max(slope_error, off / largest * facing * facing * sharpness);
  }
  CAPTURE(point_error, barycentric_error, slope_error, checked);
  CHECK(point_error < 3e-7);
  CHECK(barycentric_error < 3e-7);
  CHECK(slope_error < 6e-5);
  CHECK(checked > 5000);
}

TEST_CASE("triangles that a ray cannot meet give no hit and no NaN", "[refraction]") {
  const Ray<float> ray = {{0, 0, 0}, {0, 0, -1}};
  const RayDifferential<float> start = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto none = [&](Vec3f p0, Vec3f e1, Vec3f e2) {
    const TriangleHit<float> hit = intersect_triangle(ray, p0, e1, e2);
    const TriangleHitDerivatives<float> slope = hit_derivatives(ray, start, p0, e1, e2, hit);
    return !hit.valid && hit.t == 0.0f && hit.u == 0.0f && hit.v == 0.0f && slope.u_dx == 0.0f && slope.v_dy == 0.0f;
  };
  CHECK(none({1, 0, -1}, {0, 1, 0}, {0, 0, 1}));                // edge-on
  CHECK(none({0, 0, -1}, {0, 0, 0}, {0, 1, 0}));                // degenerate
  CHECK(none({1e30f, 0, -1}, {1e-20f, 0, 0}, {0, 1e-20f, 0}));  // beyond float
  const TriangleHit<float> behind = intersect_triangle(ray, {0, 0, 2}, {1, 0, 0}, {0, 1, 0});
  CHECK(behind.valid);
  CHECK(behind.t == -2.0f);
}
