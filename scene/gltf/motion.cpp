// Reads skins, morph weights and animations. Source: glTF 2.0 specification, 3.7.2.2, 3.7.3 and 3.11.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "scene/build/animate.h"
#include "scene/gltf/internal.h"

namespace shoal::gltf {
namespace {

class MotionReader {
 public:
  MotionReader(Document& document, Scene& scene) : document_(document), scene_(scene) {}

  void run() {
    std::vector<std::int32_t> skin_places(document_.model.skins.size(), kNoIndex);
    for (std::size_t i = 0; i < document_.model.nodes.size(); ++i) {
      const tinygltf::Node& from = document_.model.nodes[i];
      if (document_.node_places[i] == kNoIndex || from.mesh < 0) continue;
      if (from.skin >= 0) read_skin_of(i, skin_places);
      read_weights(i);
    }
    for (std::size_t a = 0; a < document_.model.animations.size(); ++a) read_animation(a);
    if (scene_.animations.empty()) scene_.locals.clear();
    if (scene_.skins.empty()) forget_joints();
    warn_left_out();
  }

 private:
  [[noreturn]] void wrong(const std::string& what, const std::string& expected) const {
    fail(document_.path, what, expected);
  }
  Node& placed(std::size_t file_node) {
    return scene_.nodes[static_cast<std::size_t>(document_.node_places[file_node])];
  }

  // --- Skins ---

  void read_skin_of(std::size_t file_node, std::vector<std::int32_t>& skin_places) {
    Node& node = placed(file_node);
    if (node.mesh == kNoIndex) return;
    const auto file_skin = static_cast<std::size_t>(document_.model.nodes[file_node].skin);
    if (skin_places[file_skin] == kNoIndex) {
      skin_places[file_skin] = static_cast<std::int32_t>(scene_.skins.size());
      scene_.skins.push_back(read_skin(file_skin));
    }
    node.skin = skin_places[file_skin];
    const std::size_t joints = scene_.skins[static_cast<std::size_t>(node.skin)].joints.size();
    for (const MeshPrimitive& primitive : scene_.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
      if (primitive.influences == 0) warn(document_, "a skinned mesh without JOINTS_0 is drawn as its node places it");
      for (std::size_t k = 0; k < primitive.joints.size(); ++k) {
        if (primitive.joints[k] >= joints) {
          wrong(label_of("nodes", file_node, node.name) + " has a mesh whose vertex " +
                    std::to_string(k / primitive.influences) + " follows joint " + std::to_string(primitive.joints[k]),
                "expected one of the " + std::to_string(joints) + " joints of its skin");
        }
      }
    }
  }

  Skin read_skin(std::size_t index) {
    const tinygltf::Skin& from = document_.model.skins[index];
    const std::string label = label_of("skins", index, from.name);
    Skin skin;
    skin.name = from.name;
    charge(document_, from.joints.size() * (sizeof(Mat4) + sizeof(std::int32_t)), label);
    for (const int joint : from.joints) {
      const std::int32_t place = document_.node_places.at(static_cast<std::size_t>(joint));
      if (place == kNoIndex) {
        wrong(
            label + " has joint " + label_of("nodes", static_cast<std::size_t>(joint)) + ", which is not in the scene",
            "expected nodes of the scene that is drawn");
      }
      skin.joints.push_back(place);
    }
    skin.joint_from_mesh.assign(skin.joints.size(), kIdentity4);
    if (from.inverseBindMatrices < 0) return skin;
    const auto accessor = static_cast<std::size_t>(from.inverseBindMatrices);
    const std::string inner = label + ".inverseBindMatrices";
    const tinygltf::Accessor& a = document_.model.accessors.at(accessor);
    if (a.type != TINYGLTF_TYPE_MAT4 || a.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
      wrong(inner + " has elements of the wrong type", "expected MAT4 of floats");
    }
    if (a.count < skin.joints.size()) {
      wrong(inner + " has " + std::to_string(a.count) + " elements",
            "expected " + std::to_string(skin.joints.size()) + ", one a joint");
    }
    const std::vector<float> values = read_floats(document_, accessor, 16, inner);
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
      const float* m = &values[16 * j];  // column-major
      if (std::fabs(m[3]) > 1e-3f || std::fabs(m[7]) > 1e-3f || std::fabs(m[11]) > 1e-3f ||
          std::fabs(m[15] - 1) > 1e-3f) {
        wrong(inner + "[" + std::to_string(j) + "] has a projective part", "expected 0 0 0 1 as its last row");
      }
      for (int c = 0; c < 4; ++c) {
        skin.joint_from_mesh[j][c] = {m[4 * c], m[4 * c + 1], m[4 * c + 2], c < 3 ? 0.0f : 1.0f};
      }
    }
    return skin;
  }

  // Removes joints and weights where no node that is drawn has a skin.
  void forget_joints() {
    for (Mesh& mesh : scene_.meshes) {
      for (MeshPrimitive& primitive : mesh.primitives) {
        primitive.influences = 0;
        primitive.joints.clear();
        primitive.weights.clear();
        primitive.flat_normals = primitive.flat_normals && !primitive.targets.empty();
      }
    }
  }

  // --- Morph weights ---

  std::size_t target_count(std::int32_t mesh) const {
    const auto& primitives = scene_.meshes[static_cast<std::size_t>(mesh)].primitives;
    return primitives.empty() ? 0 : primitives.front().targets.size();
  }

  // The weights of the node, or those of the mesh, or zeros.
  void read_weights(std::size_t file_node) {
    const tinygltf::Node& from = document_.model.nodes[file_node];
    const auto mesh = static_cast<std::size_t>(from.mesh);
    const std::size_t targets = target_count(from.mesh);
    for (const MeshPrimitive& primitive : scene_.meshes[mesh].primitives) {
      if (primitive.targets.size() != targets) {
        wrong(label_of("meshes", mesh, scene_.meshes[mesh].name) + " has primitives of " + std::to_string(targets) +
                  " and of " + std::to_string(primitive.targets.size()) + " morph targets",
              "expected as many in each");
      }
    }
    const bool own = !from.weights.empty();
    const std::vector<double>& given = own ? from.weights : document_.model.meshes[mesh].weights;
    const std::string label = own ? label_of("nodes", file_node, from.name) : label_of("meshes", mesh);
    if (!given.empty() && given.size() != targets && !scene_.meshes[mesh].primitives.empty()) {
      wrong(label + " has " + std::to_string(given.size()) + " weights",
            "expected " + std::to_string(targets) + ", one a morph target");
    }
    charge(document_, (document_.instance_counts[file_node] + std::uint64_t{1}) * targets * sizeof(float), label);
    std::vector<float> weights(targets, 0.0f);
    for (std::size_t i = 0; i < std::min(targets, given.size()); ++i) {
      weights[i] = static_cast<float>(given[i]);
      if (!(std::fabs(weights[i]) <= kMaxWeight)) {
        wrong(label + " has a weight of " + std::to_string(given[i]), "expected a number between -1e6 and 1e6");
      }
    }
    const auto place = static_cast<std::size_t>(document_.node_places[file_node]);
    for (std::size_t n = place; n <= place + document_.instance_counts[file_node]; ++n) {
      if (scene_.nodes[n].mesh != kNoIndex) scene_.nodes[n].morph_weights = weights;
    }
  }

  // --- Animations ---

  void read_animation(std::size_t index) {
    const tinygltf::Animation& from = document_.model.animations[index];
    Animation animation;
    animation.name = from.name;
    moved_.clear();
    for (std::size_t c = 0; c < from.channels.size(); ++c) {
      read_channel(from, from.channels[c], label_of("animations", index, from.name) + "." + label_of("channels", c),
                   animation);
    }
    if (!animation.channels.empty()) scene_.animations.push_back(std::move(animation));
  }

  static bool parse_path(const std::string& name, ChannelPath& path) {
    constexpr const char* kNames[] = {"translation", "rotation", "scale", "weights"};
    for (int i = 0; i < 4; ++i) {
      if (name != kNames[i]) continue;
      path = static_cast<ChannelPath>(i);
      return true;
    }
    return false;
  }

  void read_channel(const tinygltf::Animation& from, const tinygltf::AnimationChannel& file_channel,
                    const std::string& label, Animation& animation) {
    Channel channel;
    if (file_channel.target_node < 0 || !parse_path(file_channel.target_path, channel.path)) {
      warn(document_, "animation channels of '" + one_line(file_channel.target_path, 40) + "' are not read");
      return;
    }
    const auto file_node = static_cast<std::size_t>(file_channel.target_node);
    channel.node = document_.node_places.at(file_node);
    if (channel.node == kNoIndex) return;  // the node belongs to another scene
    const bool of_weights = channel.path == ChannelPath::kWeights;
    if (!of_weights && scene_.locals[static_cast<std::size_t>(channel.node)].is_matrix) {
      wrong(label + " moves " + label_of("nodes", file_node) + ", which has a matrix",
            "expected translation, rotation and scale");
    }
    if (!moved_.insert({file_node, channel.path}).second) {
      wrong(label + " moves the " + file_channel.target_path + " of " + label_of("nodes", file_node) + " a second time",
            "expected one channel for it in an animation");
    }
    const int mesh = document_.model.nodes[file_node].mesh;
    const std::size_t weights = of_weights && mesh >= 0 ? target_count(mesh) : 0;
    if (of_weights && weights == 0) {
      warn(document_, "animation channels of weights without morph targets are not read");
      return;
    }
    read_sampler(from.samplers.at(static_cast<std::size_t>(file_channel.sampler)), label, weights, channel);
    const std::uint32_t instances = of_weights ? document_.instance_counts[file_node] : 0;
    for (std::uint32_t i = 1; i <= instances; ++i) {
      charge(document_, (channel.values.size() + channel.times_s.size()) * sizeof(float), label);
      animation.channels.push_back(channel);
      animation.channels.back().node += static_cast<std::int32_t>(i);
    }
    if (instances == 0) animation.channels.push_back(std::move(channel));
  }

  void read_sampler(const tinygltf::AnimationSampler& sampler, const std::string& label, std::size_t weights,
                    Channel& channel) {
    if (sampler.interpolation == "STEP") {
      channel.interpolation = Interpolation::kStep;
    } else if (sampler.interpolation == "CUBICSPLINE") {
      channel.interpolation = Interpolation::kCubicSpline;
    } else if (!sampler.interpolation.empty() && sampler.interpolation != "LINEAR") {
      wrong(label + " interpolates by '" + one_line(sampler.interpolation, 40) + "'",
            "expected LINEAR, STEP or CUBICSPLINE");
    }
    read_times(static_cast<std::size_t>(sampler.input), label + ".input", channel);

    const auto output = static_cast<std::size_t>(sampler.output);
    const tinygltf::Accessor& a = document_.model.accessors.at(output);
    const bool rotates = channel.path == ChannelPath::kRotation, of_weights = channel.path == ChannelPath::kWeights;
    const int type = of_weights ? TINYGLTF_TYPE_SCALAR : rotates ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3;
    const int components = of_weights ? 1 : rotates ? 4 : 3;
    const bool may_normalize = (of_weights || rotates) && a.normalized;
    if (a.type != type || (a.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !may_normalize)) {
      wrong(label + ".output has elements of the wrong type",
            of_weights ? "expected SCALAR of floats or normalized integers"
            : rotates  ? "expected VEC4 of floats or normalized integers"
                       : "expected VEC3 of floats");
    }
    const std::uint64_t groups = channel.interpolation == Interpolation::kCubicSpline ? 3 : 1;
    const std::uint64_t expected = channel.times_s.size() * groups * (of_weights ? weights : 1);
    if (a.count != expected) {
      wrong(label + ".output has " + std::to_string(a.count) + " elements",
            "expected " + std::to_string(expected) + " for " + std::to_string(channel.times_s.size()) + " keys");
    }
    channel.values = read_floats(document_, output, components, label + ".output");
    for (const float v : channel.values) {
      if (std::fabs(v) > document_.limits.max_coordinate_m || (of_weights && std::fabs(v) > kMaxWeight)) {
        wrong(label + ".output holds " + std::to_string(v), "expected smaller numbers");
      }
    }
  }

  void read_times(std::size_t input, const std::string& label, Channel& channel) {
    const tinygltf::Accessor& a = document_.model.accessors.at(input);
    if (a.type != TINYGLTF_TYPE_SCALAR || a.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
      wrong(label + " has elements of the wrong type", "expected SCALAR of floats");
    }
    channel.times_s = read_floats(document_, input, 1, label);
    for (std::size_t i = 1; i < channel.times_s.size(); ++i) {
      if (channel.times_s[i] < channel.times_s[i - 1]) {
        wrong(label + "[" + std::to_string(i) + "] is " + std::to_string(channel.times_s[i]) + " s",
              "expected increasing times, after " + std::to_string(channel.times_s[i - 1]) + " s");
      }
    }
  }

  void warn_left_out() {
    const PlayingChannels playing = playing_channels(scene_);
    if (playing.left_out.empty()) return;
    std::string names;
    for (const std::size_t a : playing.left_out) {
      names += (names.empty() ? "" : ", ") + label_of("animations", a, scene_.animations[a].name);
    }
    warn(document_, names + " not played: moved already by an earlier animation");
  }

  static constexpr float kMaxWeight = 1e6f;
  Document& document_;
  Scene& scene_;
  std::set<std::pair<std::size_t, ChannelPath>> moved_;  // properties that the animation being read moves
};

}  // namespace

void read_motion(Document& document, Scene& scene) { MotionReader(document, scene).run(); }

}  // namespace shoal::gltf
