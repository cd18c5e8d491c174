// Functions shared by the files that build a RenderScene and move it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "scene/scene.h"

namespace shoal::building {

[[noreturn]] inline void fail(const Scene& scene, const Node& node, const std::string& what) {
  throw Error(scene.name + ": node '" + node.name + "': " + what);
}

inline bool is_finite(Vec3f v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// The unit vector of v, or zero where v is zero or not finite. v is divided by its largest component first, so that
// squares neither overflow nor vanish.
inline Vec3f normalize_or_zero(Vec3f v) {
  const float largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return {0, 0, 0};
  const Vec3f s = v / largest;
  return s / std::sqrt(dot(s, s));
}
inline bool is_zero(Vec3f v) { return v.x == 0 && v.y == 0 && v.z == 0; }

// The first three components of a column: an axis of the node (0 to 2) or its origin (3).
inline Vec3f column(const Mat4& t, int c) { return Vec3f(t[c]); }

// The determinant of the upper left 3 x 3 part: negative where the transform mirrors.
inline float determinant(const Mat4& t) { return dot(column(t, 0), cross(column(t, 1), column(t, 2))); }

// Transforms normals: the inverse transpose up to a positive factor, that is, the matrix of cofactors times the sign of
// the determinant.
struct NormalMatrix {
  Vec3f columns[3];

  explicit NormalMatrix(const Mat4& t) {
    // One common factor for all columns keeps the products of tiny or huge scales in range.
    const float largest = largest_component(t);
    const auto scaled = [&](int i) { return largest > 0 ? column(t, i) / largest : Vec3f{0, 0, 0}; };
    const Vec3f a = scaled(0), b = scaled(1), c = scaled(2);
    const float sign = determinant(t) < 0 ? -1.0f : 1.0f;
    columns[0] = cross(b, c) * sign;
    columns[1] = cross(c, a) * sign;
    columns[2] = cross(a, b) * sign;
  }
  Vec3f apply(Vec3f n) const {
    const Vec3f w = normalize_or_zero(columns[0] * n.x + columns[1] * n.y + columns[2] * n.z);
    return is_zero(w) ? Vec3f{0, 1, 0} : w;
  }

 private:
  static float largest_component(const Mat4& t) {
    float largest = 0;
    for (int i = 0; i < 3; ++i) {
      largest = std::max({largest, std::fabs(t[i].x), std::fabs(t[i].y), std::fabs(t[i].z)});
    }
    return largest;
  }
};

inline bool is_outline(const Scene& scene, const Node& node) {
  return node.water != kNoIndex && !scene.waters[static_cast<std::size_t>(node.water)].has_size;
}

inline const Mesh* mesh_of(const Scene& scene, const Node& node) {
  return node.mesh == kNoIndex ? nullptr : &scene.meshes[static_cast<std::size_t>(node.mesh)];
}

// These place the parts of nodes at the nodes' present transforms (scene/build/build.cpp). Each throws Error where the
// transform of a node degenerates.
//   geometry  a body without a depth reaches down to its lowest vertex; null: the depth of such a body is left 0
WaterBody place_water(const Scene& scene, std::size_t node_index, const Geometry* geometry);
PlacedCamera place_camera(const Scene& scene, const Node& node, std::size_t node_index);
Lighting make_lighting(const Scene& scene);

}  // namespace shoal::building
