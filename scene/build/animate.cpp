#include "scene/build/animate.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/math.h"

namespace shoal {
namespace {

// The number of floats in a key's value.
std::size_t width_of(const Channel& channel) {
  const std::size_t groups = channel.interpolation == Interpolation::kCubicSpline ? 3 : 1;
  return channel.values.size() / (channel.times_s.size() * groups);
}

// Scales a quaternion to unit length; one that is shorter than 1e-6 or not finite becomes 0 0 0 1.
void normalize_quaternion(std::vector<double>& q) {
  const double length = std::sqrt(((q[0] * q[0] + q[1] * q[1]) + q[2] * q[2]) + q[3] * q[3]);
  if (!(length > 1e-6) || !std::isfinite(length)) {
    q = {0, 0, 0, 1};
    return;
  }
  for (double& v : q) v /= length;
}

// Spherical interpolation along the shorter arc. Source: glTF 2.0 specification, appendix C.4.
std::vector<double> slerp(std::vector<double> a, std::vector<double> b, double t) {
  normalize_quaternion(a);
  normalize_quaternion(b);
  const double cosine = ((a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]) + a[3] * b[3];
  if (cosine < 0) {
    for (double& v : b) v = -v;
  }
  double apart = 0, together = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    apart += (b[i] - a[i]) * (b[i] - a[i]);
    together += (b[i] + a[i]) * (b[i] + a[i]);
  }
  const float angle = 2.0f * det_atan2(static_cast<float>(std::sqrt(apart)), static_cast<float>(std::sqrt(together)));
  double from = 1 - t, to = t;
  if (angle > 1e-4f) {  // for smaller angles sin x equals x in float
    from = static_cast<double>(det_sin(static_cast<float>(1 - t) * angle));
    to = static_cast<double>(det_sin(static_cast<float>(t) * angle));
  }
  std::vector<double> out(4);
  for (std::size_t i = 0; i < 4; ++i) out[i] = a[i] * from + b[i] * to;
  normalize_quaternion(out);
  return out;
}

std::vector<double> group(const Channel& channel, std::size_t index, std::size_t width) {
  const auto first = channel.values.begin() + static_cast<std::ptrdiff_t>(index * width);
  return {first, first + static_cast<std::ptrdiff_t>(width)};
}

// Cubic Hermite interpolation. Source: glTF 2.0 specification, appendix C.5.
std::vector<double> spline(const Channel& channel, std::size_t key, std::size_t width, double span_s, double t) {
  const std::vector<double> value0 = group(channel, 3 * key + 1, width), out0 = group(channel, 3 * key + 2, width);
  const std::vector<double> in1 = group(channel, 3 * key + 3, width), value1 = group(channel, 3 * key + 4, width);
  const double t2 = t * t, t3 = t2 * t;
  std::vector<double> result(width);
  for (std::size_t i = 0; i < width; ++i) {
    result[i] = ((((2 * t3 - 3 * t2) + 1) * value0[i] + span_s * ((t3 - 2 * t2) + t) * out0[i]) +
                 (3 * t2 - 2 * t3) * value1[i]) +
                span_s * (t3 - t2) * in1[i];
  }
  return result;
}

std::vector<double> interpolated(const Channel& channel, double time_s) {
  const std::size_t width = width_of(channel);
  const bool cubic = channel.interpolation == Interpolation::kCubicSpline;
  const auto value_at = [&](std::size_t key) { return group(channel, cubic ? 3 * key + 1 : key, width); };
  const std::vector<float>& times = channel.times_s;
  if (!(time_s > static_cast<double>(times.front()))) return value_at(0);
  if (time_s >= static_cast<double>(times.back())) return value_at(times.size() - 1);
  const auto next = std::upper_bound(times.begin(), times.end(), time_s,
                                     [](double t, float key_time) { return t < static_cast<double>(key_time); });
  const auto key = static_cast<std::size_t>(next - times.begin()) - 1;
  if (channel.interpolation == Interpolation::kStep) return value_at(key);
  const double begin = static_cast<double>(times[key]), span = static_cast<double>(times[key + 1]) - begin;
  const double t = (time_s - begin) / span;
  if (cubic) return spline(channel, key, width, span, t);
  if (channel.path == ChannelPath::kRotation) return slerp(value_at(key), value_at(key + 1), t);
  std::vector<double> a = value_at(key);
  const std::vector<double> b = value_at(key + 1);
  for (std::size_t i = 0; i < width; ++i) a[i] = (1 - t) * a[i] + t * b[i];
  return a;
}

void apply(const Channel& channel, double time_s, std::vector<LocalTransform>& locals, Pose& pose) {
  const std::vector<double> value = channel_value(channel, time_s);
  const auto node = static_cast<std::size_t>(channel.node);
  LocalTransform& local = locals[node];
  switch (channel.path) {
    case ChannelPath::kTranslation:
      local.translation = {value[0], value[1], value[2]};
      break;
    case ChannelPath::kRotation:
      local.rotation = {value[0], value[1], value[2], value[3]};
      break;
    case ChannelPath::kScale:
      local.scale = {value[0], value[1], value[2]};
      break;
    case ChannelPath::kWeights:
      for (std::size_t i = 0; i < value.size(); ++i) pose.morph_weights[node][i] = static_cast<float>(value[i]);
      break;
  }
}

}  // namespace

std::vector<double> channel_value(const Channel& channel, double time_s) {
  std::vector<double> value = interpolated(channel, time_s);
  if (channel.path == ChannelPath::kRotation) normalize_quaternion(value);
  return value;
}

PlayingChannels playing_channels(const Scene& scene) {
  PlayingChannels playing;
  std::set<std::pair<std::int32_t, ChannelPath>> taken;
  for (std::size_t a = 0; a < scene.animations.size(); ++a) {
    const std::vector<Channel>& channels = scene.animations[a].channels;
    const bool free = std::none_of(channels.begin(), channels.end(), [&](const Channel& c) {
      return taken.count({c.node, c.path}) != 0;
    });
    if (!free) {
      playing.left_out.push_back(a);
      continue;
    }
    for (const Channel& channel : channels) {
      taken.insert({channel.node, channel.path});
      playing.channels.push_back(&channel);
    }
  }
  return playing;
}

Pose pose_scene(const Scene& scene, double time_s) {
  Pose pose;
  pose.morph_weights.reserve(scene.nodes.size());
  pose.world_from_local.reserve(scene.nodes.size());
  for (const Node& node : scene.nodes) pose.morph_weights.push_back(node.morph_weights);
  if (scene.locals.size() != scene.nodes.size()) {
    for (const Node& node : scene.nodes) pose.world_from_local.push_back(widen(node.world_from_local));
    return pose;
  }
  std::vector<LocalTransform> locals = scene.locals;
  for (const Channel* channel : playing_channels(scene).channels) apply(*channel, time_s, locals, pose);
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const Affine local = local_affine(locals[n]);
    const std::int32_t parent = scene.nodes[n].parent;
    pose.world_from_local.push_back(
        parent == kNoIndex ? local : product(pose.world_from_local[static_cast<std::size_t>(parent)], local));
  }
  return pose;
}

std::vector<char> moving_nodes(const Scene& scene) {
  const PlayingChannels playing = playing_channels(scene);
  if (playing.channels.empty()) return {};
  std::vector<char> moves(scene.nodes.size(), 0);
  for (const Channel* channel : playing.channels) {
    char& what = moves[static_cast<std::size_t>(channel->node)];
    what = static_cast<char>(what | (channel->path == ChannelPath::kWeights ? kShapeMoves : kPlaceMoves));
  }
  for (std::size_t n = 0; n < moves.size(); ++n) {  // depth first: a parent comes before its children
    const std::int32_t parent = scene.nodes[n].parent;
    const bool carried = parent != kNoIndex && (moves[static_cast<std::size_t>(parent)] & kPlaceMoves) != 0;
    if (carried) moves[n] = static_cast<char>(moves[n] | kPlaceMoves);
  }
  return moves;
}

}  // namespace shoal
