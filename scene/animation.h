// What moves a scene: skins, morph targets, keyframes. Plain data, as a glTF file gives it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/matrix.h"

namespace shoal {

// A node's transform under its parent, in double as files give it: T R S, or a matrix that no animation may move.
struct LocalTransform {
  glm::dvec3 translation{0, 0, 0};
  glm::dvec4 rotation{0, 0, 0, 1};  // quaternion x y z w, any length but 0
  glm::dvec3 scale{1, 1, 1};
  bool is_matrix = false;
  Affine matrix = kAffineIdentity;  // where is_matrix
};

// A skinned vertex follows its joints, not its own node.
struct Skin {
  std::string name;
  std::vector<std::int32_t> joints;   // into Scene::nodes
  std::vector<Mat4> joint_from_mesh;  // inverse bind matrices, one a joint
};

// Displacements at weight 1.
struct MorphTarget {
  std::vector<Vec3f> positions;  // empty or one a vertex
  std::vector<Vec3f> normals;    // empty or one a vertex
};

enum class ChannelPath : std::uint8_t { kTranslation, kRotation, kScale, kWeights };
enum class Interpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

// One property of one node over time.
struct Channel {
  std::int32_t node = 0;  // into Scene::nodes
  ChannelPath path = ChannelPath::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times_s;  // never empty, never decreasing
  // A key after the other, each `width` floats: 3, a quaternion's 4, or as many as the node has morph targets.
  // Cubic splines have three such groups a key: in-tangent, value, out-tangent.
  std::vector<float> values;
};
struct Animation {
  std::string name;
  std::vector<Channel> channels;
};

}  // namespace shoal
