// The refracted layer of a body of water as a raster method reads it: ids and depths by pixel, and the planes of the
// triangles that are drawn there. No call gives meshlets, bounds or any triangle that the layer does not show.
#pragma once

#include "raster/resolve.h"
#include "raster/visibility.h"
#include "refraction/data/frame_grids.h"

namespace shoal {

class LayerView {
 public:
  LayerView(const VisibilityBuffer& layer, const LayerGrid& grid, const GeometryView& geometry)
      : grid_(grid), id_(layer.id.data()), depth_(layer.depth.data()), geometry_(geometry) {}

  const LayerGrid& grid() const { return grid_; }
  const std::int32_t* id() const { return id_; }  // [slots of grid().grid]
  const float* depth() const { return depth_; }   // the same; greater is nearer, 0 where nothing is drawn

  // The distance along each ray at which it intersects the plane of a triangle that the layer shows.
  //   id     a lane's triangle, read from id()
  //   lanes  that hold one
  // Returns lengths of the ray's direction, 0 where the ray is parallel to the plane.
  template <class F>
  F plane_distance(const Ray<F>& ray, IntOf<F> id, MaskOf<F> lanes) const {
    return triangle_distance(geometry_, ray, id, lanes);
  }

 private:
  const LayerGrid& grid_;
  const std::int32_t* id_;
  const float* depth_;
  const GeometryView& geometry_;
};

}  // namespace shoal
