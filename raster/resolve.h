// Resolve: from visible ids to the attributes that the pixel program reads, once for each visible pixel.
//
// A pixel's point is where its ray meets the plane of its triangle, computed from the triangle's own corners: clipping,
// subdivision and snapping have no influence on it. The same function serves view rays, refracted and reflected rays.
//
// Cost   about 60 cycles a distinct triangle of a 4 x 4 block and 250 a block (docs/PERFORMANCE.md).
#pragma once

#include <cstdint>

#include "core/ray.h"
#include "core/vec_lanes.h"
#include "raster/geometry_view.h"
#include "raster/ray_triangle.h"

namespace shoal::inline SHOAL_ISA_NS {

// Interpolated attributes of sixteen pixels; lanes that are not active hold zeros or finite leftovers.
template <class F>
struct PixelAttributes {
  Vec3<F> position_world;
  Vec3<F> normal_world;  // unit, turned to the viewer where its back faces the viewer
  Vec3<F> facet_world;   // the triangle's own normal, by its winding, of any length
  F t;                   // of the hit along the ray, in its direction's lengths
  Vec2<F> uv, duv_dx, duv_dy;
  Vec4<F> color;  // COLOR_0, 1 where there is none
  IntOf<F> material;
  // Only where the geometry has them (GeometryView):
  Vec2<F> uv1, duv1_dx, duv1_dy;
  Vec3<F> tangent_world;  // of any length; turned with the normal
  F handedness;           // the bitangent is cross(normal, tangent) times this
};

// Calls body(value, lanes) for each distinct value among the active lanes, in the order of their first lane.
template <class Body>
SHOAL_INLINE void for_each_distinct(WideI value, WideM active, Body body) {
  std::uint32_t left = to_bits(active);
  alignas(64) std::int32_t values[16];
  value.store(values);
  while (left != 0) {
    const int lane = __builtin_ctz(left);
    const std::uint32_t same = to_bits(value == WideI(values[lane])) & left;
    body(values[lane], mask_from_bits(same));
    left &= ~same;
  }
}

// The value of the first active lane; at least one lane is active.
SHOAL_INLINE std::int32_t first_value(WideI value, WideM active) {
  return extract(value, __builtin_ctz(to_bits(active)));
}

// Distances at which rays meet the planes of triangles, in their directions' lengths; -1 where they do not meet them
// and in the other lanes.
__attribute__((noinline)) inline WideF triangle_distance(const GeometryView& g, const Ray<WideF>& ray, WideI id,
                                                         WideM lanes) {
  WideF t(-1.0f);
  for_each_distinct(id, lanes, [&](std::int32_t one, WideM same) SHOAL_LAMBDA {
    const Geometry::TriangleRecord& r = g.triangles[one];
    const Vec3f a = g.vertices[r.vertex[0]].position_world;
    const Vec3f e1 = g.vertices[r.vertex[1]].position_world - a, e2 = g.vertices[r.vertex[2]].position_world - a;
    const TriangleHit<WideF> hit =
        intersect_triangle(ray, broadcast<WideF>(a), broadcast<WideF>(e1), broadcast<WideF>(e2));
    t = select(same & hit.valid, hit.t, t);
  });
  return t;
}

// The corners of the triangle of every lane. Their differences are cheaper to compute once for all lanes than once for
// each triangle.
struct TriangleLanes {
  Vec3<WideF> p0, p1, p2;
  Vec3<WideF> n0, n1, n2;
  Vec2<WideF> uv0, uv1, uv2;
  WideI material;
};

// One triangle in every lane.
SHOAL_INLINE TriangleLanes fetch_triangle(const GeometryView& g, std::int32_t id) {
  const Geometry::TriangleRecord& t = g.triangles[id];
  const VertexRecord &a = g.vertices[t.vertex[0]], &b = g.vertices[t.vertex[1]], &c = g.vertices[t.vertex[2]];
  return {broadcast<WideF>(a.position_world),
          broadcast<WideF>(b.position_world),
          broadcast<WideF>(c.position_world),
          broadcast<WideF>(a.normal_world),
          broadcast<WideF>(b.normal_world),
          broadcast<WideF>(c.normal_world),
          broadcast<WideF>(a.uv),
          broadcast<WideF>(b.uv),
          broadcast<WideF>(c.uv),
          WideI(static_cast<std::int32_t>(t.material))};
}
SHOAL_INLINE void merge_triangle(TriangleLanes& to, const TriangleLanes& t, WideM lanes) {
  to.p0 = select<WideF>(lanes, t.p0, to.p0), to.p1 = select<WideF>(lanes, t.p1, to.p1),
  to.p2 = select<WideF>(lanes, t.p2, to.p2);
  to.n0 = select<WideF>(lanes, t.n0, to.n0), to.n1 = select<WideF>(lanes, t.n1, to.n1),
  to.n2 = select<WideF>(lanes, t.n2, to.n2);
  to.uv0 = select<WideF>(lanes, t.uv0, to.uv0), to.uv1 = select<WideF>(lanes, t.uv1, to.uv1),
  to.uv2 = select<WideF>(lanes, t.uv2, to.uv2);
  to.material = select(lanes, t.material, to.material);
}

// Clamps barycentrics to the triangle: coverage is decided on the pixel grid and may exceed the triangle by 1/512 px
// (and by the broad phase's quarter of a pixel).
SHOAL_INLINE void clamp_to_triangle(WideF& u, WideF& v) {
  u = clamp(u, WideF(0.0f), WideF(1.0f));
  v = clamp(v, WideF(0.0f), WideF(1.0f) - u);
}

// COLOR_0. A function of its own, because together with the other attributes it would exceed the registers.
__attribute__((noinline)) inline void resolve_color(const GeometryView& g, WideI id, WideM active, WideF u, WideF v,
                                                    PixelAttributes<WideF>& out) {
  const WideF zero(0.0f);
  Vec4<WideF> c0{zero, zero, zero, zero}, c1 = c0, c2 = c0;
  const auto put = [](WideM lanes, const Vec4f& c, Vec4<WideF>& to) SHOAL_LAMBDA {
    to.x = select(lanes, WideF(c.x), to.x), to.y = select(lanes, WideF(c.y), to.y);
    to.z = select(lanes, WideF(c.z), to.z), to.w = select(lanes, WideF(c.w), to.w);
  };
  const auto put_all = [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
    const Geometry::TriangleRecord& t = g.triangles[one];
    put(lanes, g.colors[t.vertex[0]], c0), put(lanes, g.colors[t.vertex[1]], c1), put(lanes, g.colors[t.vertex[2]], c2);
  };
  for_each_distinct(id, active, put_all);
  const auto mixed = [&](WideF a, WideF b, WideF c) SHOAL_LAMBDA { return (a + (b - a) * u) + (c - a) * v; };
  out.color = {mixed(c0.x, c1.x, c2.x), mixed(c0.y, c1.y, c2.y), mixed(c0.z, c1.z, c2.z), mixed(c0.w, c1.w, c2.w)};
}

// The second set of texture coordinates, interpolated as the first.
__attribute__((noinline)) inline void resolve_uv1(const GeometryView& g, WideI id, WideM active, WideF u, WideF v,
                                                  const TriangleHitDerivatives<WideF>& d, PixelAttributes<WideF>& out) {
  Vec2<WideF> uv0 = broadcast<WideF>(Vec2f{0, 0}), duv1 = uv0, duv2 = uv0;
  for_each_distinct(id, active, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
    const Geometry::TriangleRecord& t = g.triangles[one];
    const Vec2f &a = g.uvs1[t.vertex[0]], &b = g.uvs1[t.vertex[1]], &c = g.uvs1[t.vertex[2]];
    uv0 = select<WideF>(lanes, broadcast<WideF>(a), uv0);
    duv1 = select<WideF>(lanes, broadcast<WideF>(b - a), duv1);
    duv2 = select<WideF>(lanes, broadcast<WideF>(c - a), duv2);
  });
  out.uv1 = uv0 + duv1 * u + duv2 * v;
  out.duv1_dx = duv1 * d.u_dx + duv2 * d.v_dx;
  out.duv1_dy = duv1 * d.u_dy + duv2 * d.v_dy;
}

// Tangents, interpolated as normals; a triangle's corners have one handedness (the first one's is taken).
__attribute__((noinline)) inline void resolve_tangent(const GeometryView& g, WideI id, WideM active, WideF u, WideF v,
                                                      WideM behind, PixelAttributes<WideF>& out) {
  const WideF w = (WideF(1.0f) - u) - v;
  Vec3<WideF> t0 = broadcast<WideF>(Vec3f{1, 0, 0}), t1 = t0, t2 = t0;
  WideF sign(1.0f);
  const auto put = [](WideM lanes, const Vec4f& t, Vec3<WideF>& to) SHOAL_LAMBDA {
    to = select<WideF>(lanes, broadcast<WideF>(Vec3f{t.x, t.y, t.z}), to);
  };
  for_each_distinct(id, active, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
    const Geometry::TriangleRecord& t = g.triangles[one];
    put(lanes, g.tangents[t.vertex[0]], t0), put(lanes, g.tangents[t.vertex[1]], t1),
        put(lanes, g.tangents[t.vertex[2]], t2);
    sign = select(lanes, WideF(g.tangents[t.vertex[0]].w), sign);
  });
  const Vec3<WideF> tangent = t0 * w + t1 * u + t2 * v;
  out.tangent_world = select<WideF>(behind, -tangent, tangent);
  // The whole frame turns: cross(-n, -t) would leave the bitangent where it was.
  out.handedness = select(behind, -sign, sign);
}

// Interpolates the attributes of the points where rays meet their triangles.
//   ray           one a lane, world; its differential: by pixel
//   id            of the active lanes: triangles
//   active        at least one lane
// Error  position: as intersect_triangle (raster/ray_triangle.h), then within the triangle.
__attribute__((noinline)) inline void resolve_attributes(const GeometryView& g, const Ray<WideF>& ray,
                                                         const RayDifferential<WideF>& differential, WideI id,
                                                         WideM active, PixelAttributes<WideF>& out) {
  const std::int32_t first = first_value(id, active);
  TriangleLanes t = fetch_triangle(g, first);
  for_each_distinct(id, active & (id != WideI(first)), [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
    merge_triangle(t, fetch_triangle(g, one), lanes);
  });
  const Vec3<WideF> e1 = t.p1 - t.p0, e2 = t.p2 - t.p0;
  const TriangleHit<WideF> hit = intersect_triangle(ray, t.p0, e1, e2);
  const TriangleHitDerivatives<WideF> d = hit_derivatives(ray, differential, t.p0, e1, e2, hit);
  WideF u = hit.u, v = hit.v;
  clamp_to_triangle(u, v);
  const WideF w = (WideF(1.0f) - u) - v;
  out.t = hit.t;
  out.position_world = t.p0 + e1 * u + e2 * v;
  // Where the triangle's back faces the viewer (double-sided materials), the normal is turned to the viewer.
  const Vec3<WideF> normal = normalize(t.n0 * w + t.n1 * u + t.n2 * v);
  out.facet_world = cross(e1, e2);
  const WideM behind = dot(out.facet_world, ray.direction_world) > WideF(0.0f);
  out.normal_world = select<WideF>(behind, -normal, normal);
  const Vec2<WideF> duv1 = t.uv1 - t.uv0, duv2 = t.uv2 - t.uv0;
  out.uv = t.uv0 + duv1 * u + duv2 * v;
  out.duv_dx = duv1 * d.u_dx + duv2 * d.v_dx;
  out.duv_dy = duv1 * d.u_dy + duv2 * d.v_dy;
  out.material = t.material;
  const WideF one(1.0f);
  out.color = {one, one, one, one};
  if (g.colors != nullptr) resolve_color(g, id, active, u, v, out);
  if (g.uvs1 != nullptr) resolve_uv1(g, id, active, u, v, d, out);
  if (g.tangents != nullptr) resolve_tangent(g, id, active, u, v, behind, out);
}

}  // namespace shoal::inline SHOAL_ISA_NS
