// The direct pass of a frame with each of its stages callable by itself, set up as refraction/renderer.cpp does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/thread_pool.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/targets.h"
#include "refraction/data/view_state.h"
#include "refraction/methods/kernels.h"
#include "scene/scene_view.h"

namespace shoal::bench {

class Stages {
 public:
  //   scene  drawn without its water; must outlive this
  Stages(const RenderScene& scene, int width_px, int height_px, int threads);

  void set_camera(const Camera& camera);
  void front_end();  // meshlets to bins
  void tiles();      // bins to visibility and depth

  // Calls body(region) for each 64-pixel region, on all threads.
  template <class Body>
  void for_each_region(Body body) {
    pool_.for_each(grids_.frame.region_count(), [&](std::size_t region, int) { body(region); });
  }

  // Of the last front_end: triangles in meshlets that were not culled, and triangles binned.
  std::uint64_t triangles_in() const;
  std::uint64_t triangles_out() const;

  const SceneView& scene() const { return scene_; }
  const View& view() const { return view_.view; }
  const FrameGrid& grid() const { return grids_.frame; }
  const VisibilityBuffer& direct() const { return targets_.direct; }

 private:
  const FrameKernels& kernels_;
  ThreadPool pool_;
  std::vector<DrawState> states_;  // of the materials
  SceneView scene_;
  FrameGrids grids_;
  ViewState view_;
  PassBins bins_;
  Targets targets_;
};

}  // namespace shoal::bench
