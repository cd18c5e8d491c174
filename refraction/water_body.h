// The parts of a frame that are one stage there and several here: a body of water, blended materials in front of the
// scene, and the pixels of a traced method.
#pragma once

#include "refraction/frame.h"

namespace shoal {

// Draws the layers of a body and shades its water pixels into Targets::water_light; nothing where it does not show.
// The stages from the interface to the water's light run region by region, in the scratch of a thread.
void draw_water_body(const FrameIn& in, const ViewState& view, const WaterOptics& optics, const FrameOut& out,
                     const Run& run);

// The direct pass of a method whose layer is the frame without its water: the scene into Targets::refracted, then the
// outlines of the water over it into Targets::direct.
//   pass  of the direct pass, outlines first
void draw_scene_then_water(const FrameIn& in, const TilePassIn& pass, const FrameOut& out, Stage& stage);

// Composites the blended materials of the direct pass into Targets::blended_direct.
void blend_in_front(const FrameIn& in, const ViewState& view, const FrameOut& out, const Run& run);

// Every pixel by a traced method's rays.
void trace_pixels(const FrameIn& in, const ViewState& view, const FrameOut& out, const Run& run);

}  // namespace shoal
