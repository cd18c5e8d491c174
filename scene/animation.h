// Skins, morph targets and keyframes as plain data, as a glTF file gives them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/matrix.h"

namespace shoal {

// The transform of a node relative to its parent, in double as files give it: translation, rotation and scale, or a
// matrix, which no animation may change.
struct LocalTransform {
  glm::dvec3 translation{0, 0, 0};
  glm::dvec4 rotation{0, 0, 0, 1};  // quaternion x y z w, any length but 0
  glm::dvec3 scale{1, 1, 1};
  bool is_matrix = false;
  Affine matrix = kAffineIdentity;  // used where is_matrix
};

// A skin. The joints place its vertices; the transform of the mesh's own node does not.
struct Skin {
  std::string name;
  std::vector<std::int32_t> joints;   // into Scene::nodes
  std::vector<Mat4> joint_from_mesh;  // inverse bind matrices, one a joint
};

// Displacements of vertices at weight 1.
struct MorphTarget {
  std::vector<Vec3f> positions;  // empty or one a vertex
  std::vector<Vec3f> normals;    // empty or one a vertex
};

enum class ChannelPath : std::uint8_t { kTranslation, kRotation, kScale, kWeights };
enum class Interpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

// The keyframes of one property of one node.
struct Channel {
  std::int32_t node = 0;  // into Scene::nodes
  ChannelPath path = ChannelPath::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times_s;  // never empty, never decreasing
  // One group of floats for each key: 3 of a translation or scale, 4 of a quaternion, or as many as the node has morph
  // targets. A cubic spline has three such groups a key: in-tangent, value, out-tangent.
  std::vector<float> values;
};
struct Animation {
  std::string name;
  std::vector<Channel> channels;
};

}  // namespace shoal
