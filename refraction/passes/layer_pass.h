// Front ends of the refracted and the planar reflection pass of a body of water, and those of blended materials.
#pragma once

#include <vector>

#include "refraction/data/frame_grids.h"
#include "refraction/data/method_state.h"
#include "refraction/passes/direct_pass.h"

namespace shoal {

struct LayerPassIn {
  const GeometryView& geometry;
  const ViewState& view;
  const WaterPass& pass;
  const MethodState& state;  // of the method, whose own map may depend on its options
};

// The blended meshlets of the scene as a pass's front end takes them.
struct BlendedPassIn {
  const GeometryView& geometry;
  const ViewState& view;
  const WaterPass* pass;  // null: the direct pass
  const std::vector<std::uint32_t>& meshlets;
  const BinGrid& regions;             // of the pass's grid
  const std::int32_t* region_active;  // [regions] 0: nothing is binned there; null: all are active
  const MethodState& state;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// The scene at its virtual positions (WaterOptics::map), and mirrored in the plane.
void refracted_front_end(const LayerPassIn& in, const BinsOut& out, std::size_t work_item);
void reflected_front_end(const LayerPassIn& in, const BinsOut& out, std::size_t work_item);

// The blended meshlets of the direct pass, or of a body's pass, by the same programs.
void blended_front_end(const BlendedPassIn& in, const BinsOut& out, std::size_t work_item);

// The pass's settings for blended meshlets.
SHOAL_INLINE PassSettings blended_settings(const BlendedPassIn& in) {
  PassSettings pass = in.pass != nullptr ? in.pass->pass : in.view.direct_pass;
  pass.skip_blended = false;
  pass.grid = in.regions;
  pass.tile_active = in.region_active;
  return pass;
}

}  // namespace shoal::inline SHOAL_ISA_NS
