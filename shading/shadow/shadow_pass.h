// The sun's depth passes: geometry into bins, and bins into the depth of one tile of a map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raster/clip.h"
#include "raster/pass_bins.h"
#include "raster/setup.h"
#include "raster/visibility.h"
#include "shading/shading_view.h"
#include "shading/shadow/shadow_map.h"

namespace shoal {

// Part of the scene drawn into a map: all of it, or what lies on one side of the water.
struct ShadowPass {
  GeometryView geometry;                // its draw states are double-sided
  const std::uint8_t* casts = nullptr;  // by material: 0 casts no shadow
  const ShadowMap* map = nullptr;
  PassSettings pass;
  bool clipped = false;
  Plane keep{{0, 0, 0}, 0};  // where clipped: the part of the world that is drawn
  bool sheared = false;      // this is the part below the plane
};

// One work item of a pass.
struct ShadowFrontEndIn {
  const ShadowPass& pass;
  std::uint32_t first_meshlet, last_meshlet;  // the last is not of the work item
};

// One tile of a map.
struct ShadowTileIn {
  const ShadingView& view;
  const std::vector<ShadowPass>& passes;  // of the map
  const std::vector<PassBins>& bins;      // of each pass
  std::size_t tile;                       // of the passes' grid
};

// The kernels of one instruction set.
struct ShadowKernels {
  void (*shadow_front_end)(const ShadowFrontEndIn& in, WorkItemBins& out);
  void (*draw_shadow_tile)(const ShadowTileIn& in, VisibilityBuffer& out);
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

ShadowKernels make_shadow_kernels();

}  // namespace shoal::inline SHOAL_ISA_NS
