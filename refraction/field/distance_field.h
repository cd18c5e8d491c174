// A voxel distance field of what lies on one side of a plane of water: at each voxel's centre how far the nearest
// triangle is, and which one.
#pragma once

#include <cstdint>
#include <vector>

#include "core/thread_pool.h"
#include "refraction/data/method_state.h"
#include "scene/scene.h"

namespace shoal {

// A box of cubic voxels in the plane's own frame: x and z along the body's axes, y along its normal, from its origin.
struct DistanceField {
  Vec3f min_m{0, 0, 0};  // the first voxel's outer corner
  float voxel_m = 0;     // 0: there is nothing on this side, and nothing is held
  std::int32_t count_x = 0, count_y = 0, count_z = 0;
  std::vector<float> distance_m;      // x fastest, then y, then z
  std::vector<std::int32_t> nearest;  // triangle id

  bool empty() const { return voxel_m == 0; }
  std::size_t bytes() const { return distance_m.size() * sizeof(float) + nearest.size() * sizeof(std::int32_t); }
};

// Both sides of every body of water, and what building them took.
struct DistanceFields : MethodData {
  std::vector<DistanceField> below, above;  // [bodies]
  double build_ms = 0;
  std::size_t bytes() const;
  std::vector<std::pair<std::string, double>> figures() const override {
    return {{"field_build_ms", build_ms}, {"field_mb", static_cast<double>(bytes()) / 1048576.0}};
  }
  // Builds both sides of each body; with a camera only the sides that its rays enter, and the others stay as they are.
  void build(const RenderScene& scene, const Camera* camera, int resolution, ThreadPool& pool);
};

// Into the plane's frame, and vectors likewise.
Vec3f to_plane(const WaterBody& body, Vec3f p_world);

// Builds one side's field.
//
//   below       true: what lies under the plane within the outline's bounds, for an eye above it; false: all of the
//               scene above the plane
//   resolution  voxels along the box's longest side, 8 to 512
// Opaque triangles that are drawn take part, both sides of them alike; cut-outs as if they were whole.
// Returns the field. It depends on neither the threads nor anything but scene and resolution.
// Source: Rodgman and Chen 2001 (refraction in discretely sampled distance fields); the field itself: exact distances
// in
//         a band of voxels about each triangle, then the nearest triangle handed on from voxel to voxel, six sweeps of
//         nine neighbours each, in the manner of Danielsson 1980.
// Error: within 1.5 voxels of a surface exact up to rounding; beyond never too small, and too great by at most 0.02
//        voxels on the test's scene (tests/refraction/test_distance_field.cpp).
DistanceField build_distance_field(const RenderScene& scene, const WaterBody& body, bool below, int resolution,
                                   ThreadPool& pool);

}  // namespace shoal
