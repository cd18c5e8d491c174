// One frame, start to end: the page to read first.
//
// Every stage is a call with its inputs and outputs, on all threads, one after the other. The files of
// refraction/passes/ and refraction/narrow/ hold the stages; docs/FRAME.md follows one water pixel through this page.
#include "refraction/frame.h"

#include "refraction/water_body.h"

namespace shoal {

void draw_sample(const FrameIn& in, const ViewState& view, const FrameOut& out, const Run& run) {
  const SceneView& scene = in.scene;
  const FrameKernels& kernels = in.kernels;
  const FrameGrid& frame = in.grids.frame;
  Targets& t = out.targets;
  FrameWork& work = out.work;

  {  // 1 Water: where each body is, seen from the eye, and which one the eye is in.
    Stage stage(run, "water");
    const Reflections total = in.method.traces ? Reflections::kTraced : Reflections::kPlanar;
    place_water({scene.water, view.view, in.method.map, in.reflections, total, in.method.whole_scene},
                {work.water, out.eye_in_water});
    clear_blended(t);
  }
  if (in.method.trace != nullptr) return trace_pixels(in, view, out, run);  // a traced method: rays alone

  {  // 2 Direct: vertex -> clip -> setup -> bin -> visibility; the water's surface is one of its primitives.
    Stage stage(run, "direct.front_end");
    kernels.outline_front_end({in.outlines, work.water, view}, {work.outline_bins});
    stage.for_each(work.bins.work_items.size(), [&](std::size_t work_item) {
      kernels.direct_front_end({scene.geometry(), view}, {work.bins}, work_item);
    });
  }
  {
    Stage stage(run, "direct.visibility");
    const AlphaTestIn alpha{scene.shading, view.view, frame, nullptr, nullptr, nullptr};
    const TilePassIn pass{&work.outline_bins, work.bins, in.grids.tiles, 0, kernels.direct_alpha_test, alpha};
    if (in.method.whole_scene && !work.water.empty())
      draw_scene_then_water(in, pass, out, stage);
    else
      stage.for_each(in.grids.tile_count(), [&](std::size_t tile) { kernels.draw_tile(pass, t.direct, tile); });
  }
  if (any_displaced(work.water)) {
    Stage stage(run, "water.surface");
    const DisplacedWaterIn water{view, frame, work.water};
    stage.for_each(frame.region_count(), [&](std::size_t r) { kernels.draw_displaced_water(water, t.direct, r); });
  }
  run.digest({"visibility.direct", "depth.direct"});

  // 3, 4 Each body of water that shows: its layers, then, region by region, interface, narrow phase and water light.
  for (const WaterOptics& optics : work.water) draw_water_body(in, view, optics, out, run);
  run.digest({"interface"});

  // 5 Transparent: blended materials in front of all that, by (depth, id) at each sample.
  if (!in.blended_meshlets.empty()) blend_in_front(in, view, out, run);
  run.digest({"blended"});

  {  // 6 Shade: visible ids -> attributes -> textures -> light -> 8-bit pixels, region by region while it is in cache.
    Stage stage(run, "shade");
    const BlendLayer* blended = in.blended_meshlets.empty() ? nullptr : &t.blended_direct;
    const ShadeIn shade{scene, view, in.grids, t.direct, t.water_light, blended, in.post};
    const ShadeOut picture{t.gbuffer, t.lit, t.srgb8.data()};
    stage.for_each(frame.region_count(), [&](std::size_t region) { kernels.shade(shade, picture, region); });
  }
  run.digest({"gbuffer", "hit"});
}

}  // namespace shoal
