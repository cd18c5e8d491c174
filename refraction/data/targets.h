// The buffers of a frame, each a named target, and the one table of them: it gives their allocation, their digests and
// the channels that they lend to AOVs.
#pragma once

#include <cstdint>
#include <vector>

#include "core/blocked_image.h"
#include "raster/visibility.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/water_interface.h"
#include "shading/transparency.h"

namespace shoal {

using FloatPlane = AlignedArray<float>;
using IntPlane = AlignedArray<std::int32_t>;

struct PlaneXyz {
  FloatPlane x, y, z;
};

// The surface that each pixel shows, of the sample at its centre; at water pixels the water's own surface. The resolve
// part of the shade stage writes it, block by block; it is stored whole only when it is captured.
struct GBuffer {
  PlaneXyz position_world;
  PlaneXyz normal_world;  // unit
  PlaneXyz base_color;    // linear; 0 at water pixels
  FloatPlane metallic, roughness;
};

// The water interface of each water pixel, 0 elsewhere: what the interface stage found.
struct InterfaceTarget {
  FloatPlane t;           // in lengths of the view ray's direction
  PlaneXyz normal_world;  // unit
  FloatPlane slope_variance;
  PlaneXyz refracted, reflected;  // unit, world
};

// What each water pixel shows.
struct HitPoints {
  IntPlane kind;            // HitKind
  IntPlane id;              // triangle, or kNoId
  PlaneXyz position_world;  // 0 where the kind has no point
  PlaneXyz virtual_world;   // where the point appears through flat water
  IntPlane secondary;       // 1: the ray that the pixel shows crosses a secondary water interface
  IntPlane approximate;     // 1: the pixel shows a candidate that its ray does not hit (HitBlock), or an image-space
                            // method sampled its layer outside of the frame
};

// The refracted layer of an image-space method, lit.
struct LitLayer {
  PlaneXyz radiance;        // linear
  PlaneXyz position_world;  // of each point; 0 where there is none
};

// Linear light, the average over the samples when the last one is in.
struct LitBuffer {
  FloatPlane red, green, blue, alpha;
};

// Light that water pixels show, before blended materials in front of them and exposure.
struct WaterLight {
  PlaneXyz radiance;
};

struct Targets {
  VisibilityBuffer direct, refracted, reflected;
  VisibilityBuffer refracted_behind, reflected_behind;  // the nearest triangles behind those of the layers
  BlendLayer blended_direct, blended_refracted, blended_reflected;
  LitLayer layer;
  InterfaceTarget interface;
  GBuffer gbuffer;
  HitPoints hits;
  WaterLight water_light;
  LitBuffer lit;
  std::vector<std::uint8_t> srgb8;  // RGB rows, the picture
};

// When a target exists.
struct TargetNeeds {
  bool water = false;      // the scene has water
  bool lit_layer = false;  // the method lights its layer
  bool behind = false;     // the method searches second layers
  bool blended = false;    // the scene has blended materials
  bool capture = false;    // digests or AOVs are wanted
  bool linear = false;     // linear light is kept or averaged
};

// A row of the table of targets.
struct TargetInfo {
  const char* stage;  // the digest's name; null: the target is in no digest
  bool of_layers;     // on the layers' grid, drawn regions only; else on the frame's
  bool exists;
  const char* aov = nullptr;  // the AOV that shows the target as it is (refraction/aov.cpp has those that convert)
  int regions = 0;  // of LayerRegions, what the target fills: 0 drawn, 1, 2 behind (refracted, reflected), 3 lit
};

// Calls visit(TargetInfo, plane) for every plane of every target in the order of their digests.
//   T  Targets or const Targets
template <class T, class Visit>
void visit_planes(T& t, const TargetNeeds& needs, Visit visit) {
  const auto xyz = [&](const TargetInfo& info, auto& planes) {
    visit(info, planes.x), visit(info, planes.y), visit(info, planes.z);
  };
  visit(TargetInfo{"visibility.direct", false, true}, t.direct.id);
  visit(TargetInfo{"depth.direct", false, true}, t.direct.depth);
  visit(TargetInfo{"visibility.refracted", true, needs.water}, t.refracted.id);
  visit(TargetInfo{"depth.refracted", true, needs.water}, t.refracted.depth);
  visit(TargetInfo{"visibility.reflected", true, needs.water}, t.reflected.id);
  visit(TargetInfo{"depth.reflected", true, needs.water}, t.reflected.depth);
  visit(TargetInfo{"visibility.refracted.behind", true, needs.water && needs.behind, nullptr, 1},
        t.refracted_behind.id);
  visit(TargetInfo{"depth.refracted.behind", true, needs.water && needs.behind, nullptr, 1}, t.refracted_behind.depth);
  visit(TargetInfo{"visibility.reflected.behind", true, needs.water && needs.behind, nullptr, 2},
        t.reflected_behind.id);
  visit(TargetInfo{"depth.reflected.behind", true, needs.water && needs.behind, nullptr, 2}, t.reflected_behind.depth);
  const TargetInfo layer{"layer", true, needs.water && needs.lit_layer, nullptr, 3};
  xyz(layer, t.layer.radiance), xyz(layer, t.layer.position_world);
  const TargetInfo interface { "interface", false, needs.water&& needs.capture };
  visit(interface, t.interface.t), xyz(interface, t.interface.normal_world);
  visit(interface, t.interface.slope_variance);
  xyz(interface, t.interface.refracted), xyz(interface, t.interface.reflected);
  const TargetInfo gbuffer{"gbuffer", false, needs.capture};
  xyz({"gbuffer", false, needs.capture, "position"}, t.gbuffer.position_world);
  xyz({"gbuffer", false, needs.capture, "normal"}, t.gbuffer.normal_world);
  xyz(gbuffer, t.gbuffer.base_color);
  visit(gbuffer, t.gbuffer.metallic), visit(gbuffer, t.gbuffer.roughness);
  visit(TargetInfo{"hit", false, needs.capture, "hit.kind"}, t.hits.kind);
  visit(TargetInfo{"hit", false, needs.capture}, t.hits.id);
  xyz({"hit", false, needs.capture, "hit.position"}, t.hits.position_world);
  xyz({nullptr, false, needs.capture}, t.hits.virtual_world);
  visit(TargetInfo{nullptr, false, needs.capture, "hit.approximate"}, t.hits.approximate);
  visit(TargetInfo{nullptr, false, needs.capture, "hit.secondary"}, t.hits.secondary);
  xyz(TargetInfo{nullptr, false, needs.water}, t.water_light.radiance);
  const TargetInfo lit{"lit", false, needs.linear};
  visit(lit, t.lit.red), visit(lit, t.lit.green), visit(lit, t.lit.blue), visit(lit, t.lit.alpha);
}

// Makes room for the targets that exist; the others stay empty.
void allocate(Targets& targets, const FrameGrids& grids, const TargetNeeds& needs);

// Empties what is captured, for a new sample: no surface, no water, no hit.
void clear_captured(Targets& targets);
// Empties the layers of blended materials, for a new sample.
void clear_blended(Targets& targets);

}  // namespace shoal
