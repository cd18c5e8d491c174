#include "refraction/data/targets.h"

#include <algorithm>

#include "scene/hit_kind.h"

namespace shoal {

void allocate(Targets& targets, const FrameGrids& grids, const TargetNeeds& needs) {
  visit_planes(targets, needs, [&](const TargetInfo& info, auto& plane) {
    if (info.exists) plane.resize((info.of_layers ? grids.layers.grid : grids.frame).pixel_slots());
  });
  targets.direct.grid = grids.frame;
  targets.refracted.grid = targets.reflected.grid = grids.layers.grid;
  targets.refracted_behind.grid = targets.reflected_behind.grid = grids.layers.grid;
  if (needs.blended) {
    targets.blended_direct.resize(grids.frame);
    if (needs.water) targets.blended_refracted.resize(grids.frame), targets.blended_reflected.resize(grids.frame);
  }
}

namespace {
void fill(FloatPlane& plane, float value) { std::fill_n(plane.data(), plane.size(), value); }
void fill(IntPlane& plane, std::int32_t value) { std::fill_n(plane.data(), plane.size(), value); }
void fill(PlaneXyz& planes, float value) { fill(planes.x, value), fill(planes.y, value), fill(planes.z, value); }
}  // namespace

void clear_captured(Targets& targets) {
  GBuffer& g = targets.gbuffer;
  for (PlaneXyz* planes : {&g.position_world, &g.normal_world, &g.base_color}) fill(*planes, 0.0f);
  fill(g.metallic, 0.0f), fill(g.roughness, 0.0f);
  HitPoints& h = targets.hits;
  fill(h.kind, static_cast<std::int32_t>(HitKind::kNoWater)), fill(h.id, kNoId), fill(h.approximate, 0),
      fill(h.secondary, 0);
  fill(h.position_world, 0.0f), fill(h.virtual_world, 0.0f);
  InterfaceTarget& i = targets.interface;
  fill(i.t, 0.0f), fill(i.slope_variance, 0.0f);
  for (PlaneXyz* planes : {&i.normal_world, &i.refracted, &i.reflected}) fill(*planes, 0.0f);
}

void clear_blended(Targets& targets) {
  for (BlendLayer* layer : {&targets.blended_direct, &targets.blended_refracted, &targets.blended_reflected})
    std::fill_n(layer->filled.data(), layer->filled.size(), std::uint8_t{0});
}

}  // namespace shoal
