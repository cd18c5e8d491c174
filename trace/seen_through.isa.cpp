// Blended triangles on the way of rays (trace/trace_rays.h), found by ray queries and composited in exact order.
#include "trace/trace_rays.h"

#include "raster/resolve.h"
#include "scene/water_absorption.h"
#include "shading/shade_hits.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Layers a ray keeps a round.
constexpr int kLayers = 8;

// Which of two hits along a ray is in front: the nearer one, at the same distance the smaller id.
SHOAL_INLINE WideM nearer(WideF t, WideI id, WideF other_t, WideI other_id) {
  return (t < other_t) | ((t == other_t) & (id < other_id));
}

// The nearest blended triangles of sixteen rays that are beyond `taken` and in front of `end`, sorted. What does not
// fit is found again by a further round, as raster/fragments.h has it.
struct BlendedLists {
  BlendedLists(const GeometryView& g, const Ray<WideF>& along, const PathSegment& segment)
      : geometry(g), ray(along), t_near(segment.t_near), end_t(segment.end_t), end_id(segment.end_id) {}

  const GeometryView& geometry;
  const Ray<WideF>& ray;
  float t_near;
  WideF end_t;
  WideI end_id;
  WideF taken_t{-1.0f};
  WideI taken_id{kNoId};
  WideF t[kLayers];
  WideI id[kLayers];
  int count = 0;
  WideM dropped = mask_from_bits(0);

  __attribute__((noinline)) void insert(WideI candidates, WideM lanes) {
    const Geometry::TriangleRecord* triangles = geometry.triangles;
    WideF at = triangle_distance(geometry, ray, candidates, lanes);
    WideM wanted = lanes & (at > WideF(0.0f)) & (at >= WideF(t_near)) & nearer(at, candidates, end_t, end_id) &
                   nearer(taken_t, taken_id, at, candidates);
    for_each_distinct(candidates, wanted, [&](std::int32_t one, WideM same) SHOAL_LAMBDA {
      if (geometry.draw_states[triangles[one].material].double_sided) return;
      const Vec3f facet = facet_of(one);
      wanted = wanted & !(same & (dot(broadcast<WideF>(facet), ray.direction_world) > WideF(0.0f)));
    });
    for (int n = 0; n < count; ++n) wanted = wanted & !((id[n] == candidates) & (t[n] == at));
    if (none(wanted)) return;
    // Each lane into its own list: what is displaced moves on to the next layer.
    at = select(wanted, at, WideF(kNowhere));
    WideI which = select(wanted, candidates, WideI(kNoId));
    for (int n = 0; n < count; ++n) {
      const WideM here = nearer(at, which, t[n], id[n]);
      const WideF next_t = select(here, t[n], at);
      const WideI next_id = select(here, id[n], which);
      t[n] = select(here, at, t[n]);
      id[n] = select(here, which, id[n]);
      at = next_t, which = next_id;
    }
    const WideM left = which != WideI(kNoId);
    if (none(left)) return;
    if (count == kLayers) {
      dropped = dropped | left;
      return;
    }
    t[count] = at, id[count] = which;
    ++count;
  }

  static constexpr float kNowhere = 3.402823466e38f;

 private:
  Vec3f facet_of(std::int32_t one) const {
    const Geometry::TriangleRecord& r = geometry.triangles[one];
    const Vec3f a = geometry.vertices[r.vertex[0]].position_world;
    return cross(geometry.vertices[r.vertex[1]].position_world - a, geometry.vertices[r.vertex[2]].position_world - a);
  }
};

void visit(void* context, const RayPacket&, const std::int32_t* id, std::uint32_t lanes) {
  alignas(64) std::int32_t aligned_id[16];
  for (int i = 0; i < 16; ++i) aligned_id[i] = id[i];
  static_cast<BlendedLists*>(context)->insert(WideI::load(aligned_id), mask_from_bits(lanes));
}

}  // namespace

SeenThrough seen_through(const RayQueries& rays, const SceneView& scene, const Ray<WideF>& ray,
                         const RayDifferential<WideF>& differential, const PathSegment& segment, WideM lanes) {
  SeenThrough sum;
  const PlacedWater* water = segment.body < 0 ? nullptr : &scene.water[static_cast<std::size_t>(segment.body)];
  const LightMedium* medium = segment.body < 0 ? nullptr : &scene.light_media[segment.body];
  // Embree's distances differ from ours by rounding: the query reaches a little farther, and our distances decide.
  const WideF reach = min(segment.end_t * WideF(1.0001f), WideF(3e38f));
  RayPacket packet;
  fill_packet(packet, ray, 0.0f, reach);
  BlendedLists lists(scene.geometry(), ray, segment);
  for (WideM open = lanes; any(open);) {
    lists.count = 0, lists.dropped = mask_from_bits(0);
    rays.each_blended(packet, to_bits(open), &visit, &lists);
    for (int n = 0; n < lists.count; ++n) {
      const WideM here = open & is_triangle(lists.id[n]) & (sum.transmittance > WideF(0.0f));
      if (none(here)) continue;
      ShadedLanes s;
      shade_hits(scene.shading, ray, differential, lists.id[n], here, medium, s);
      Vec3<WideF> light = s.radiance;
      if (water != nullptr) light = light * absorbed(*water->body, max(s.t * length(ray.direction_world), WideF(0.0f)));
      const WideF alpha = clamp(s.surface.alpha, WideF(0.0f), WideF(1.0f));
      sum.light = select<WideF>(here, sum.light + light * (sum.transmittance * alpha), sum.light);
      sum.transmittance = select(here, sum.transmittance * (WideF(1.0f) - alpha), sum.transmittance);
    }
    open = open & lists.dropped & (sum.transmittance > WideF(0.0f));
    if (none(open)) break;
    lists.taken_t = lists.t[kLayers - 1], lists.taken_id = lists.id[kLayers - 1];
  }
  return sum;
}

}  // namespace shoal::inline SHOAL_ISA_NS
