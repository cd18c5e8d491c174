// Front ends of the direct pass: the scene, and the outlines of the bodies of water.
#pragma once

#include <vector>

#include "raster/pass_bins.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"
#include "scene/scene_view.h"

namespace shoal {

struct DirectPassIn {
  const GeometryView& geometry;
  const ViewState& view;
};
struct OutlinePassIn {
  const OutlineView& outlines;
  const std::vector<WaterOptics>& water;
  const ViewState& view;
};
struct BinsOut {
  PassBins& bins;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Work item `work_item`: meshlets through vertex, clip and setup into its bins.
void direct_front_end(const DirectPassIn& in, const BinsOut& out, std::size_t work_item);

// The outlines of all bodies whose surface is their plane, one work item a body. They are drawn before the scene.
void outline_front_end(const OutlinePassIn& in, const BinsOut& out);

}  // namespace shoal::inline SHOAL_ISA_NS
