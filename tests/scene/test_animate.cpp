// Keyframes against double and the standard library; which animations play; which nodes move.
#include <catch2/catch.hpp>

#include "scene/build/animate.h"
#include "tests/scene/motion_oracle.h"

namespace shoal::test {
namespace {

// A number of -1 to 1, the same on every machine.
float noise(std::uint32_t& state) {
  state = state * 1664525u + 1013904223u;
  return static_cast<float>(static_cast<std::int32_t>(state)) / 2147483648.0f;
}

Channel random_channel(ChannelPath path, Interpolation interpolation, std::size_t width, std::uint32_t seed) {
  Channel c;
  c.path = path;
  c.interpolation = interpolation;
  c.times_s = {-0.5f, 0.25f, 0.25f, 1.0f, 3.5f, 3.625f};
  const std::size_t count = c.times_s.size() * width * (interpolation == Interpolation::kCubicSpline ? 3 : 1);
  for (std::size_t i = 0; i < count; ++i) c.values.push_back(noise(seed));
  return c;
}

double angle_between(const std::vector<double>& a, const std::vector<double>& b) {
  double apart = 0, together = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    apart += (a[i] - b[i]) * (a[i] - b[i]);
    together += (a[i] + b[i]) * (a[i] + b[i]);
  }
  return 4 * std::atan2(std::sqrt(std::min(apart, together)), std::sqrt(std::max(apart, together)));
}

Scene nodes_in_a_row(std::size_t count) {
  Scene scene;
  scene.nodes.resize(count);
  scene.locals.resize(count);
  return scene;
}

Channel slide(std::int32_t node, float to_x) {
  Channel c;
  c.node = node;
  c.times_s = {0, 1};
  c.values = {0, 0, 0, to_x, 0, 0};
  return c;
}

}  // namespace

TEST_CASE("animate: keys of every kind against double", "[animate]") {
  double worst_angle = 0, worst_value = 0;
  for (const Interpolation how : {Interpolation::kStep, Interpolation::kLinear, Interpolation::kCubicSpline}) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
      const Channel moved = random_channel(ChannelPath::kTranslation, how, 3, seed);
      const Channel turned = random_channel(ChannelPath::kRotation, how, 4, seed);
      const Channel morphed = random_channel(ChannelPath::kWeights, how, 5, seed);
      for (double t = -1; t < 4.5; t += 0.0371) {
        for (const Channel* c : {&moved, &morphed}) {
          const std::vector<double> got = channel_value(*c, t), want = value_at(*c, t);
          REQUIRE(got.size() == want.size());
          for (std::size_t i = 0; i < got.size(); ++i) worst_value = std::max(worst_value, std::fabs(got[i] - want[i]));
        }
        worst_angle = std::max(worst_angle, angle_between(channel_value(turned, t), value_at(turned, t)));
      }
    }
  }
  CAPTURE(worst_value, worst_angle);
  CHECK(worst_value < 1e-12);
  CHECK(worst_angle < 1e-6);
}

TEST_CASE("animate: rotations between close, opposite and equal keys", "[animate]") {
  for (const double angle : {0.0, 1e-7, 1e-5, 1e-4, 3e-4, 1e-3, 0.1, 3.0, 3.14159, 3.5, 6.2}) {
    Channel c;
    c.path = ChannelPath::kRotation;
    c.times_s = {0, 1};
    c.values = {0, 0, 0, 2, 0, static_cast<float>(std::sin(angle / 2)), 0, static_cast<float>(std::cos(angle / 2))};
    for (const double t : {0.0, 0.125, 0.5, 0.9, 1.0}) {
      CAPTURE(angle, t);
      CHECK(angle_between(channel_value(c, t), value_at(c, t)) < 1e-6);
    }
  }
}

TEST_CASE("animate: a channel stands at its ends before and after its keys", "[animate]") {
  const Channel c = slide(0, 7);
  CHECK(channel_value(c, -5)[0] == 0);
  CHECK(channel_value(c, 0)[0] == 0);
  CHECK(channel_value(c, 0.25)[0] == 1.75);
  CHECK(channel_value(c, 1)[0] == 7);
  CHECK(channel_value(c, 1e9)[0] == 7);
}

TEST_CASE("animate: a spline that passes through zero turns nothing", "[animate]") {
  Channel c;
  c.path = ChannelPath::kRotation;
  c.interpolation = Interpolation::kCubicSpline;
  c.times_s = {0, 1};
  c.values = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0};
  const std::vector<double> q = channel_value(c, 0.5);
  CHECK(q == std::vector<double>{0, 0, 0, 1});
}

TEST_CASE("animate: the first animation plays, and those that move other things", "[animate]") {
  Scene scene = nodes_in_a_row(3);
  scene.animations.push_back({"walk", {slide(0, 1), slide(1, 1)}});
  scene.animations.push_back({"run", {slide(1, 2), slide(2, 2)}});
  scene.animations.push_back({"door", {slide(2, 3)}});
  const PlayingChannels playing = playing_channels(scene);
  REQUIRE(playing.channels.size() == 3);
  CHECK(playing.left_out == std::vector<std::size_t>{1});
  const Pose pose = pose_scene(scene, 1);
  CHECK(pose.world_from_local[0][3].x == 1);
  CHECK(pose.world_from_local[1][3].x == 1);
  CHECK(pose.world_from_local[2][3].x == 3);
}

TEST_CASE("animate: children move with their parents", "[animate]") {
  Scene scene = nodes_in_a_row(4);
  scene.nodes[1].parent = 0;
  scene.nodes[2].parent = 1;
  scene.locals[2].translation[1] = 5;
  scene.animations.push_back({"", {slide(1, 2)}});
  const std::vector<char> moves = moving_nodes(scene);
  CHECK(moves == std::vector<char>{0, kPlaceMoves, kPlaceMoves, 0});
  const Pose pose = pose_scene(scene, 0.5);
  CHECK(pose.world_from_local[2][3].x == 1);
  CHECK(pose.world_from_local[2][3].y == 5);
  CHECK(moving_nodes(nodes_in_a_row(2)).empty());
}

}  // namespace shoal::test
