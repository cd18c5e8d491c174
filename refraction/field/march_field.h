// Sphere tracing through a distance field.
#pragma once

#include "raster/bin.h"
#include "raster/resolve.h"
#include "refraction/field/distance_field.h"
#include "refraction/field/point_triangle.h"
#include "water/body.h"

namespace shoal {

struct MarchSettings {
  float stop_voxels;  // a ray that passes the nearest triangle no farther than this hits it
  int most_steps;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

struct FieldHit {
  WideI id;   // kNoId: the ray leaves the field, or has no steps left
  WideF t;    // where the ray intersects the triangle's plane; 0 where it hits none
  int steps;  // of the lane that took the most
};

// Within this many voxels of a surface the ray is tested against the nearest triangle; it counts where the ray meets
// its plane no farther than this along the ray.
inline constexpr float kNearVoxels = 1.0f, kAheadVoxels = 2.0f;

// Where the field is sampled: between the centres of eight voxels, and the voxel that holds the point.
struct FieldSample {
  WideF distance_m;
  WideI slot;  // into DistanceField::nearest
};

SHOAL_INLINE FieldSample sample_field(const DistanceField& field, Vec3<WideF> p) {
  const WideF inv(1.0f / field.voxel_m);
  const auto axis = [&](WideF at, float min_m, std::int32_t count, WideF& share, WideI& nearest) SHOAL_LAMBDA {
    const WideF centres =
        clamp((at - WideF(min_m)) * inv - WideF(0.5f), WideF(0.0f), WideF(static_cast<float>(count - 1)));
    const WideF first = min(floor(centres), WideF(static_cast<float>(count - 2)));
    share = centres - first;
    nearest = to_int_trunc(centres + WideF(0.5f));
    return to_int_trunc(first);
  };
  WideF u, v, w;
  WideI nx, ny, nz;
  const WideI x = axis(p.x, field.min_m.x, field.count_x, u, nx), y = axis(p.y, field.min_m.y, field.count_y, v, ny),
              z = axis(p.z, field.min_m.z, field.count_z, w, nz);
  const WideI row(field.count_x), slice(field.count_x * field.count_y);
  const WideI at = z * slice + y * row + x;
  const float* d = field.distance_m.data();
  const WideF one(1.0f);
  const auto along_x = [&](WideI from)
                           SHOAL_LAMBDA { return gather(d, from) * (one - u) + gather(d, from + WideI(1)) * u; };
  const WideF near_z = along_x(at) * (one - v) + along_x(at + row) * v;
  const WideF far_z = along_x(at + slice) * (one - v) + along_x(at + slice + row) * v;
  return {near_z * (one - w) + far_z * w, nz * slice + ny * row + nx};
}

// How far the ray goes in the field's box, from a start in it.
SHOAL_INLINE WideF exit_distance(const DistanceField& field, Vec3<WideF> from, Vec3<WideF> direction) {
  const auto axis = [&](WideF o, WideF d, float lo, std::int32_t count) SHOAL_LAMBDA {
    const float hi = lo + field.voxel_m * static_cast<float>(count);
    const WideF way = select(d > WideF(0.0f), WideF(hi), WideF(lo)) - o;
    const WideM moves = abs(d) > WideF(1e-9f);
    return select(moves, max(way / select(moves, d, WideF(1.0f)), WideF(0.0f)), WideF(1e9f));
  };
  return min(min(axis(from.x, direction.x, field.min_m.x, field.count_x),
                 axis(from.y, direction.y, field.min_m.y, field.count_y)),
             axis(from.z, direction.z, field.min_m.z, field.count_z));
}

struct PlaneHit {
  WideF t;
  WideM held;
};

// Where rays intersect the planes of triangles. It holds within `reach_m` of the triangle, and from its front (from
// both sides of a double-sided one).
SHOAL_INLINE PlaneHit meet_plane(const GeometryView& g, const Ray<WideF>& ray, WideI id, float reach_m, WideM lanes) {
  Vec3<WideF> p0{}, e1{}, e2{};
  WideM two_sided = mask_from_bits(0);
  for_each_distinct(id, lanes, [&](std::int32_t one, WideM same) SHOAL_LAMBDA {
    const Geometry::TriangleRecord& r = g.triangles[one];
    const Vec3f a = g.vertices[r.vertex[0]].position_world;
    p0 = select<WideF>(same, broadcast<WideF>(a), p0);
    e1 = select<WideF>(same, broadcast<WideF>(g.vertices[r.vertex[1]].position_world - a), e1);
    e2 = select<WideF>(same, broadcast<WideF>(g.vertices[r.vertex[2]].position_world - a), e2);
    if (g.draw_states[r.material].double_sided) two_sided = two_sided | same;
  });
  const TriangleHit<WideF> hit = intersect_triangle(ray, p0, e1, e2);
  const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
  const Vec3<WideF> at = (ray.origin_world - p0) + ray.direction_world * hit.t;
  const WideM front = dot(cross(e1, e2), ray.direction_world) < WideF(0.0f);
  return {hit.t,
          lanes & hit.valid & (front | two_sided) & (triangle_distance2(at, zero, e1, e2) <= WideF(reach_m * reach_m))};
}

// Marches rays until they hit something.
//
//   body   whose plane's frame the field is in
//   ray    world, unit direction; of `lanes`
// A step goes half a voxel less than the field's distance, and at least half a voxel.
// Source: Hart 1996 (sphere tracing); Rodgman and Chen 2001.
// Differs: near a surface the ray is tested against the nearest triangle itself, instead of stopping short of it.
__attribute__((noinline)) inline FieldHit march_field(const DistanceField& field, const WaterBody& body,
                                                      const GeometryView& g, const Ray<WideF>& ray,
                                                      const MarchSettings& settings, WideM lanes) {
  FieldHit out{WideI(kNoId), WideF(0.0f), 0};
  if (field.empty()) return out;
  const auto turned = [&](Vec3<WideF> v) SHOAL_LAMBDA {
    return Vec3<WideF>{dot(v, broadcast<WideF>(body.axis_x)), dot(v, broadcast<WideF>(body.normal)),
                       dot(v, broadcast<WideF>(body.axis_z))};
  };
  const Vec3<WideF> from = turned(ray.origin_world - broadcast<WideF>(body.origin)),
                    along = turned(ray.direction_world);
  const WideF end = exit_distance(field, from, along);
  const float voxel = field.voxel_m;
  WideF t(0.0f);
  WideM open = lanes;
  for (; out.steps < settings.most_steps && any(open); ++out.steps) {
    const FieldSample at = sample_field(field, from + along * t);
    const WideM beside = open & (at.distance_m < WideF(kNearVoxels * voxel));
    if (any(beside)) {
      const WideI id = gather(field.nearest.data(), at.slot);
      const PlaneHit hit = meet_plane(g, ray, id, settings.stop_voxels * voxel, beside);
      const WideM met = hit.held & (hit.t > WideF(0.0f)) & (abs(hit.t - t) <= WideF(kAheadVoxels * voxel));
      out.id = select(met, id, out.id);
      out.t = select(met, hit.t, out.t);
      open = open & !met;
    }
    t = t + max(at.distance_m - WideF(0.5f * voxel), WideF(0.5f * voxel));
    open = open & (t <= end);
  }
  return out;
}

}  // namespace shoal::inline SHOAL_ISA_NS
