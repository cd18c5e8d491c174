// Vertices of a primitive in world space under a pose: morphed, then skinned or transformed by their node.
#pragma once

#include <vector>

#include "scene/build/animate.h"
#include "scene/build/building.h"
#include "scene/build/tangents.h"

namespace shoal::building {

// The joint matrices of a skin, mesh to world. Each is one product in double, rounded to float once.
inline std::vector<Mat4> joint_matrices(const Skin& skin, const Pose& pose) {
  std::vector<Mat4> joints;
  joints.reserve(skin.joints.size());
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const Affine& world = pose.world_from_local[static_cast<std::size_t>(skin.joints[j])];
    joints.push_back(narrow(product(world, widen(skin.joint_from_mesh[j]))));
  }
  return joints;
}

inline bool is_skinned(const Node& node, const MeshPrimitive& mesh) {
  return node.skin != kNoIndex && mesh.influences != 0;
}

// Computes the vertices of one primitive of one node; any number of threads may call it. Sums over targets and joints
// run in the file's order, in float.
// Source: glTF 2.0 specification, 3.7.2.2 (morph targets), 3.7.3 (skins: the node's own transform is ignored).
// Differs: the winding of a skinned mesh is that of its first joint's matrix.
// Error: 4e-6 of the extent of the mesh, against double (tests/scene/test_motion.cpp).
class Deformer {
 public:
  //   pose  the pose of the scene's nodes; it and the mesh must outlive the deformer
  Deformer(const Scene& scene, const Pose& pose, std::size_t node_index, const MeshPrimitive& mesh)
      : mesh_(mesh),
        weights_(pose.morph_weights[node_index]),
        world_(narrow(pose.world_from_local[node_index])),
        normal_matrix_(world_) {
    const Node& node = scene.nodes[node_index];
    if (is_skinned(node, mesh)) joints_ = joint_matrices(scene.skins[static_cast<std::size_t>(node.skin)], pose);
    morphs_ = std::min(mesh.targets.size(), weights_.size());
    deforms_ = !joints_.empty() || morphs_ != 0;
  }

  // True where the transform reverses the winding of front faces.
  bool mirrored() const { return determinant(joints_.empty() ? world_ : joints_.front()) < 0; }

  Vec3f position(std::size_t v) const {
    if (!deforms_) return transform_point(world_, mesh_.positions[v]);
    const Vec3f p = morphed_position(v);
    return joints_.empty() ? transform_point(world_, p) : transform_point(blended(v), p);
  }

  // The unit normal.
  Vec3f normal(std::size_t v) const {
    if (!deforms_) return normal_matrix_.apply(mesh_.normals[v]);
    if (mesh_.flat_normals) return flat_normal(v / 3 * 3);
    const Vec3f n = morphed_normal(v);
    return joints_.empty() ? normal_matrix_.apply(n) : NormalMatrix(blended(v)).apply(n);
  }

  bool has_tangents() const { return !mesh_.tangents.empty(); }
  // Requires has_tangents. Morph targets do not change tangents.
  Vec4f tangent(std::size_t v) const { return place_tangent(joints_.empty() ? world_ : blended(v), mesh_.tangents[v]); }

 private:
  Vec3f morphed_position(std::size_t v) const {
    Vec3f p = mesh_.positions[v];
    for (std::size_t t = 0; t < morphs_; ++t) {
      if (weights_[t] != 0 && !mesh_.targets[t].positions.empty()) p = p + mesh_.targets[t].positions[v] * weights_[t];
    }
    return p;
  }
  Vec3f morphed_normal(std::size_t v) const {
    Vec3f n = mesh_.normals[v];
    for (std::size_t t = 0; t < morphs_; ++t) {
      if (weights_[t] != 0 && !mesh_.targets[t].normals.empty()) n = n + mesh_.targets[t].normals[v] * weights_[t];
    }
    return n;
  }
  // The weighted sum of the joint matrices of a vertex.
  Mat4 blended(std::size_t v) const {
    Mat4 sum = from_rows({0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0});
    const std::size_t first = v * mesh_.influences;
    for (std::size_t k = first; k < first + mesh_.influences; ++k) {
      const float weight = mesh_.weights[k];
      if (weight == 0) continue;
      const Mat4& joint = joints_[mesh_.joints[k]];
      for (int c = 0; c < 4; ++c) {
        sum[c].x = sum[c].x + joint[c].x * weight;
        sum[c].y = sum[c].y + joint[c].y * weight;
        sum[c].z = sum[c].z + joint[c].z * weight;
      }
    }
    return sum;
  }
  // The unit normal on the front of the triangle whose corners are the three vertices from `first` on.
  Vec3f flat_normal(std::size_t first) const {
    const Vec3f a = position(first), b = position(first + 1), c = position(first + 2);
    const Vec3f n = normalize_or_zero(cross(normalize_or_zero(b - a), normalize_or_zero(c - a)));
    if (is_zero(n)) return {0, 1, 0};
    return mirrored() ? -n : n;
  }

  const MeshPrimitive& mesh_;
  const std::vector<float>& weights_;
  std::vector<Mat4> joints_;  // empty: the node's transform places the mesh
  Mat4 world_;
  NormalMatrix normal_matrix_;
  std::size_t morphs_ = 0;
  bool deforms_ = false;
};

}  // namespace shoal::building
