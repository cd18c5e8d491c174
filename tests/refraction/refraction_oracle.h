// What every pixel must show, by brute force in double: its ray against every triangle, Snell's law at the water, flat
// or with waves, the refracted (or totally reflected) ray against every triangle again. No acceleration, no clipping,
// no raster, and no function of the renderer: it reads the scene's plain data alone
// (tests/structure/oracle_functions.sh).
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../water/surface_oracle.h"
#include "scene/hit_kind.h"
#include "scene/scene.h"
#include "tests/refraction/double_vector.h"

namespace shoal_test {

inline constexpr std::uint32_t kNothing = 0xFFFFFFFFu;

// One pixel as the AOVs report it.
struct OraclePixel {
  bool water = false;
  double depth_m = std::numeric_limits<double>::infinity();  // along the view axis
  std::uint32_t triangle = kNothing;
  Vec3d position{0, 0, 0};  // of what shows first, the water's surface included
  HitKind hit_kind = HitKind::kNoWater;
  std::uint32_t hit_id = kNothing;
  Vec3d hit_position{0, 0, 0};
  double path_m = 0;  // from the eye to the hit, or to what shows first
  // What magnifies rounding: the least cosine between a ray and what it meets (the water's far side included), times
  // the sine of the hit triangle's first corner; of what shows first, and of the hit.
  double steepness = 1, hit_steepness = 1;
  // Under waves: metres that the hit may move by one metre of the point on the surface and by one of slope's rounding.
  double hit_by_surface = 0, hit_by_slope = 0;
  bool bent = false;   // the waves' normal is not one that the plane can bear
  bool again = false;  // the ray that goes on meets the displaced surface before its hit

  bool shows_the_same(const OraclePixel& o) const {
    return water == o.water && triangle == o.triangle && hit_kind == o.hit_kind && hit_id == o.hit_id;
  }
};

class RefractionOracle {
 public:
  //   bend  false: rays go straight through the water (method none)
  RefractionOracle(const RenderScene& scene, bool bend) : scene_(scene), bend_(bend) {
    const Geometry& g = scene.geometry;
    for (const Drawable& d : g.drawables) {
      if (!d.drawn) continue;
      for (std::uint32_t i = 0; i < d.triangle_count; ++i) {
        const Geometry::TriangleRecord& t = g.triangles[d.first_triangle + i];
        const Vec3d a = as_double(g.vertices[t.vertex[0]].position_world),
                    b = as_double(g.vertices[t.vertex[1]].position_world);
        const Vec3d c = as_double(g.vertices[t.vertex[2]].position_world);
        triangles_.push_back({a, b - a, c - a, cross(b - a, c - a), d.first_triangle + i,
                              scene.materials.materials[t.material].double_sided});
      }
    }
  }

  // The surface of each body: waves' normals on the plane, or displaced where the body is. None set: all are flat.
  void set_waves(std::vector<WaterSurface> surfaces) { surfaces_ = std::move(surfaces); }

  // The camera's ray through a point of the frame, in double from the camera itself.
  OraclePixel trace(const Camera& camera, int width_px, int height_px, double x_px, double y_px) const {
    const double w = width_px, h = height_px, x = x_px - 0.5 * w, y = 0.5 * h - y_px;
    const Vec3d right = as_double(camera.right_world), up = as_double(camera.up_world),
                forward = as_double(camera.forward_world);
    Vec3d o = as_double(camera.position_world), d = forward;
    if (camera.orthographic) {
      o = o + right * (x * 2.0 * static_cast<double>(camera.xmag_m) / w) +
          up * (y * 2.0 * static_cast<double>(camera.ymag_m) / h);
    } else {
      const double per_px = 2.0 * static_cast<double>(camera.tan_half_yfov) / h;
      d = forward + right * (x * per_px) + up * (y * per_px);
    }
    OraclePixel out;
    const double near_m = static_cast<double>(camera.near_m);
    const Hit direct = nearest(o, d, near_m);
    const WaterBody* body = nullptr;
    double t_water = direct.t;
    for (const WaterBody& b : scene_.waters) {
      const double t = crossing(b, o, d);
      if (t >= near_m && t <= t_water) t_water = t, body = &b;
    }
    const double t = body != nullptr ? t_water : direct.t;
    if (!std::isfinite(t)) return out;
    out.depth_m = t;  // d has length 1 along the axis
    out.position = o + d * t;
    out.path_m = t * norm_of(d);
    out.steepness = body != nullptr ? std::fabs(dot(unit_of(d), as_double(body->normal))) : direct.steepness;
    if (body == nullptr) {
      out.triangle = direct.id;
      return out;
    }
    out.water = true;
    follow(*body, unit_of(d), out);
    return out;
  }

  // Height of a body's waves over the plane at a point, and the unit normal there; after set_waves.
  double surface_height(std::size_t body, Vec3d p) const {
    const WaterBody& b = scene_.waters[body];
    return surface_oracle::height(surfaces_[body], along(b, p, b.axis_x), along(b, p, b.axis_z));
  }
  Vec3d surface_up(std::size_t body, Vec3d p) const { return normal_at(scene_.waters[body], p).up; }

 private:
  struct Triangle {
    Vec3d p, e1, e2, n;
    std::uint32_t id;
    bool two_sided;
  };
  struct Hit {
    double t = std::numeric_limits<double>::infinity();
    std::uint32_t id = kNothing;
    double steepness = 1;
  };

  Hit nearest(Vec3d o, Vec3d d, double t_min) const {
    Hit best;
    for (const Triangle& tri : triangles_) {
      const double facing = dot(d, tri.n);
      if (facing == 0 || (facing > 0 && !tri.two_sided)) continue;
      const double t = dot(tri.p - o, tri.n) / facing;
      if (!(t > t_min) || t >= best.t) continue;
      const Vec3d r = o + d * t - tri.p;
      const double nn = dot(tri.n, tri.n), u = dot(cross(r, tri.e2), tri.n) / nn, v = dot(cross(tri.e1, r), tri.n) / nn;
      if (u < 0 || v < 0 || u + v > 1) continue;
      const double cosine = std::fabs(facing) / (norm_of(d) * std::sqrt(nn)),
                   sine = std::sqrt(nn) / (norm_of(tri.e1) * norm_of(tri.e2));
      best = {t, tri.id, cosine * sine};
    }
    return best;
  }

  // Of a ray with a body's outline; infinity: none.
  double crossing(const WaterBody& body, Vec3d o, Vec3d d) const {
    if (displaced(body)) return first_crossing(body, o, d);
    const Vec3d n = as_double(body.normal), origin = as_double(body.origin);
    const double t = dot(origin - o, n) / dot(d, n);
    if (!(t > 0) || !inside(body, o + d * t)) return std::numeric_limits<double>::infinity();
    return t;
  }
  static bool inside(const WaterBody& body, Vec3d p) {
    const Vec3d n = as_double(body.normal);
    for (std::size_t i = 0; i + 2 < body.outline.size(); i += 3) {
      const Vec3d a = as_double(body.outline[i]), b = as_double(body.outline[i + 1]),
                  c = as_double(body.outline[i + 2]);
      const double ab = dot(cross(b - a, p - a), n), bc = dot(cross(c - b, p - b), n), ca = dot(cross(a - c, p - c), n);
      if ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0)) return true;
    }
    return false;
  }

  const WaterSurface* surface_of(const WaterBody& body) const {
    return surfaces_.empty() || body.surface.kind == SurfaceKind::kFlat
               ? nullptr
               : &surfaces_[static_cast<std::size_t>(&body - scene_.waters.data())];
  }
  bool displaced(const WaterBody& body) const {
    return surface_of(body) != nullptr && body.surface.geometry == WaterGeometry::kDisplaced;
  }
  static double along(const WaterBody& body, Vec3d p, Vec3f axis) {
    return dot(p - as_double(body.origin), as_double(axis));
  }
  double gap(const WaterBody& body, Vec3d p) const {
    return along(body, p, body.normal) -
           surface_oracle::height(*surface_of(body), along(body, p, body.axis_x), along(body, p, body.axis_z));
  }
  // The first change of side within the greatest heights, by dense samples and halving.
  double first_crossing(const WaterBody& body, Vec3d o, Vec3d d) const {
    const double none = std::numeric_limits<double>::infinity();
    const double bound = static_cast<double>(surface_of(body)->height_bound_m), y = along(body, o, body.normal),
                 rise = dot(d, as_double(body.normal));
    const double a = (bound - y) / rise, b = (-bound - y) / rise, step = 2e-3 / norm_of(d);
    const double from = std::max(std::min(a, b), 0.0), to = std::min(std::max(a, b), from + 6.0 / norm_of(d));
    if (!(to > from)) return none;
    double t = from;
    bool above = gap(body, o + d * t) > 0;
    while (t < to) {
      const double next = t + step;
      const bool there = gap(body, o + d * next) > 0;
      if (there != above && inside(body, o + d * next)) {
        double lo = t, hi = next;
        for (int i = 0; i < 40; ++i) ((gap(body, o + d * (0.5 * (lo + hi))) > 0) == above ? lo : hi) = 0.5 * (lo + hi);
        return hi;
      }
      above = there;
      t = next;
    }
    return none;
  }

  struct SurfaceNormal {
    Vec3d up{0, 1, 0};
    double curvature = 0;  // 1/m
  };
  SurfaceNormal normal_at(const WaterBody& body, Vec3d p) const {
    const WaterSurface* surface = surface_of(body);
    const Vec3d n = as_double(body.normal);
    if (surface == nullptr) return {n, 0};
    const double x = along(body, p, body.axis_x), z = along(body, p, body.axis_z), h = 1e-4;
    const auto at = [&](double i, double k) { return surface_oracle::height(*surface, x + i * h, z + k * h); };
    const double sx = (at(1, 0) - at(-1, 0)) / (2 * h), sz = (at(0, 1) - at(0, -1)) / (2 * h), here = 2 * at(0, 0);
    const double xx = (at(1, 0) + at(-1, 0) - here) / (h * h), zz = (at(0, 1) + at(0, -1) - here) / (h * h),
                 xz = (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1)) / (4 * h * h);
    return {unit_of(n - as_double(body.axis_x) * sx - as_double(body.axis_z) * sz),
            std::sqrt(xx * xx + zz * zz + 2 * xz * xz)};
  }

  // The normal that a flat plane can bear, from its definition: what it refracts leaves through the plane and what it
  // reflects comes back, both by a thousandth or half of what the plane's own normal gives. An invalid direction is
  // turned to the nearest valid one, and the normal is the one that gives that direction.
  struct ValidNormal {
    Vec3d normal;
    bool bent;
  };
  static ValidNormal valid_normal_of(Vec3d d, Vec3d plane, Vec3d wave, double eta) {
    const auto refracted = [&](Vec3d n, Vec3d& to) {
      const double cosine = -dot(d, n), sin2 = eta * eta * (1.0 - cosine * cosine);
      if (sin2 >= 1.0) return false;
      to = d * eta + n * (eta * cosine - std::sqrt(1.0 - sin2));
      return true;
    };
    const auto reflected = [&](Vec3d n) { return d - n * (2.0 * dot(d, n)); };
    const auto turned = [](Vec3d v, Vec3d up, double least) {
      return up * least + unit_of(v - up * dot(v, up)) * std::sqrt(1.0 - least * least);
    };
    const double back = std::min(1e-3, -0.5 * dot(d, plane));
    Vec3d through_plane;
    const double through = refracted(plane, through_plane) ? std::min(1e-3, -0.5 * dot(through_plane, plane)) : 1e-3;
    Vec3d n = wave, to;
    bool bent = false;
    if (dot(d, n) >= 0.0) {
      n = unit_of(n - d * dot(d, n)), bent = true;
    } else if (refracted(n, to) && -dot(to, plane) < through) {
      n = unit_of(d * eta - turned(to, -plane, through)), bent = true;
      if (dot(d, n) > 0.0) n = -n;
    }
    if (dot(reflected(n), plane) < back) n = unit_of(turned(reflected(n), plane, back) - d), bent = true;
    const bool fails = dot(d, n) >= 0.0 || (refracted(n, to) && -dot(to, plane) < 0.5 * through) ||
                       dot(reflected(n), plane) < 0.5 * back;
    return {fails ? plane : n, bent};
  }

  // On through the surface, or back down from it.
  void follow(const WaterBody& body, Vec3d d, OraclePixel& out) const {
    const SurfaceNormal surface = normal_at(body, out.position);
    const bool moved = displaced(body), from_water = dot(d, moved ? surface.up : as_double(body.normal)) > 0;
    const double turn = from_water ? -1.0 : 1.0;
    Vec3d n = surface.up * turn;
    const double ior = static_cast<double>(body.ior), eta = from_water ? ior : 1.0 / ior;
    if (surface_of(body) != nullptr && !moved) {
      const ValidNormal valid = valid_normal_of(d, as_double(body.normal) * turn, n, eta);
      n = valid.normal, out.bent = valid.bent;
    }
    const double cos_i = -dot(d, n), sin2_t = eta * eta * (1.0 - cos_i * cos_i);
    const bool total = sin2_t > 1.0;
    Vec3d on = d + n * (2.0 * cos_i);
    double cosine = cos_i;
    if (!total) {
      cosine = bend_ ? std::sqrt(1.0 - sin2_t) : cos_i;
      on = bend_ ? d * eta + n * (eta * cos_i - cosine) : d;
    }
    const Hit hit = nearest(out.position, on, 1e-9);
    if (moved) {
      const Vec3d off = out.position + n * ((total ? 1.0 : -1.0) * 1e-6);
      out.again = first_crossing(body, off, on) < hit.t;
    }
    out.hit_kind = HitKind::kSky;
    if (!std::isfinite(hit.t)) return;
    out.hit_kind = total ? HitKind::kMirror : HitKind::kSurface;
    out.hit_id = hit.id;
    out.hit_position = out.position + on * hit.t;
    out.path_m += hit.t;
    out.hit_steepness = std::min(cos_i, cosine) * hit.steepness;
    out.hit_by_slope = hit.t * 2.0 / out.hit_steepness;
    out.hit_by_surface = surface.curvature * out.hit_by_slope;
    if (moved) out.steepness = std::min(out.steepness, cos_i);
  }

  const RenderScene& scene_;
  bool bend_;
  std::vector<Triangle> triangles_;
  std::vector<WaterSurface> surfaces_;  // empty: all flat
};

}  // namespace shoal_test
