// A body of water as one view sees it, and the passes that draw what lies beyond its surface.
#pragma once

#include "core/ray.h"
#include "raster/clip.h"
#include "raster/cull.h"
#include "raster/setup.h"
#include "refraction/broad/broad_phase.h"
#include "refraction/data/reflections.h"
#include "water/placed_water.h"

namespace shoal {

// A body of water seen from one eye: what the pixel stages read of it.
struct WaterOptics {
  PlacedWater water;
  BroadPhase exact;                // the body's plane with its true index of refraction
  BroadPhase map;                  // the map that its refracted layer is drawn with: the method's choice
  float near_m = 0;                // of the camera: displaced water nearer than this is not crossed
  RayDifferential<float> pixel{};  // of the camera's rays
  Reflections reflections = Reflections::kEnvironment;  // what its surface reflects on the eye's side
  bool whole_scene = false;  // its layer is the whole scene without water, not the far side of the plane alone
  const WaterBody& body() const { return *water.body; }
  const WaterSurface* surface() const { return water.surface; }
  // Does the surface reflect the scene, not the background alone?
  bool reflects_scene() const { return reflections != Reflections::kEnvironment; }
};

enum class WaterPassKind : std::uint8_t { kRefracted, kReflected };

// One pass over the scene's geometry for a body of water.
struct WaterPass {
  WaterPassKind kind = WaterPassKind::kRefracted;
  const WaterOptics* optics = nullptr;
  Plane clip_plane{{0, 0, 0}, 0};  // world: geometry on its positive side is drawn
  Frustum frustum;                 // of the bounds of the layer's drawn regions
  PassSettings pass;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// The differential of the eye's rays, where the water's waves are filtered over the pixel; else null.
SHOAL_INLINE const RayDifferential<float>* filtering_pixel(const WaterOptics& optics) {
  return optics.surface() != nullptr && optics.surface()->filtered ? &optics.pixel : nullptr;
}

// The water's surface as the eye's rays cross it, waves included.
SHOAL_INLINE WaterSide eye_side(const WaterOptics& optics) {
  WaterSide side = water_side(optics.body(), optics.surface(), optics.exact.eye_below);
  side.t_near = optics.near_m;
  side.pixel = filtering_pixel(optics);
  return side;
}

SHOAL_INLINE bool is_displaced(const WaterOptics& optics) { return is_displaced(optics.body(), optics.surface()); }

}  // namespace shoal::inline SHOAL_ISA_NS
