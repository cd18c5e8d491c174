// The direct pass of a frame with each of its stages callable by itself, set up as refraction/renderer.cpp does.
#pragma once

#include "core/thread_pool.h"
#include "refraction/methods/kernels.h"
#include "scene/scene.h"

namespace shoal::bench {

class Stages {
 public:
  //   scene  drawn without its water; must outlive this
  Stages(const RenderScene& scene, int width_px, int height_px, int threads);

  void look(const Camera& camera);
  void front_end();  // meshlets to bins
  void tiles();      // bins to visibility and depth

  // Calls body(region) for each 64-pixel region, on all threads.
  template <class Body>
  void for_each_region(Body body) {
    pool_.for_each(regions(), [&](std::size_t region, int) { body(region); });
  }
  std::size_t regions() const {
    return static_cast<std::size_t>(frame_.grid.regions_x) * static_cast<std::size_t>(frame_.grid.regions_y);
  }

  // Of the last front_end: triangles in meshlets that were not culled, and triangles binned.
  std::uint64_t triangles_in() const;
  std::uint64_t triangles_out() const;

  const FrameData& frame() const { return frame_; }
  FrameData& frame() { return frame_; }

 private:
  const FrameKernels& kernels_;
  ThreadPool pool_;
  FrameData frame_;
};

}  // namespace shoal::bench
