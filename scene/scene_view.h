// A scene at one time, as the stages of a frame read it: nobody writes it.
#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"
#include "shading/shading_view.h"
#include "water/placed_water.h"

namespace shoal {

// Everything that it points to outlives the frame.
struct SceneView {
  ShadingView shading;                       // geometry, materials, lights, the sun's shadows
  std::span<const PlacedWater> water;        // the bodies at this time
  const LightMedium* light_media = nullptr;  // of the bodies: how sunlight reaches points in them
  std::span<const Drawable> drawables;       // in order of their triangles
  std::int32_t triangle_count = 0;           // of the whole scene

  const GeometryView& geometry() const { return shading.geometry; }
  const Background& background() const { return shading.lighting->background; }
};

// The outlines of the bodies of water as drawables of their own, seen from both sides.
struct OutlineView {
  GeometryView geometry;
  const std::uint32_t* first_meshlet = nullptr;  // of body b; one more at the end
  std::size_t body_count = 0;
};

}  // namespace shoal
