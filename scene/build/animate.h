// Transforms of nodes and morph weights at a time, from keyframes.
#pragma once

#include <vector>

#include "scene/build/transform.h"
#include "scene/scene.h"

namespace shoal {

// The channels that play, in the file's order. The first animation plays, and so does every further one that shares no
// property of a node with an animation that plays already: alternative animations of one figure do not mix, while
// animations of different objects run together.
struct PlayingChannels {
  std::vector<const Channel*> channels;
  std::vector<std::size_t> left_out;  // animations that do not play
};
PlayingChannels playing_channels(const Scene& scene);

struct Pose {
  std::vector<Affine> world_from_local;           // one a node, in double
  std::vector<std::vector<float>> morph_weights;  // one a node, empty where it has none
};

// Evaluates a scene at a time. Nodes that nothing animates keep their matrices bit for bit.
//   scene   its `locals` are as many as its `nodes`, or none: then the pose holds the nodes' own matrices
//   time_s  finite; channels hold their first and last key beyond their ends and do not repeat
// Source: glTF 2.0 specification, 3.11 and appendix C (interpolation).
// Differs: slerp's angle is 2 atan2(|b - a|, |b + a|), which loses no digits where the keys are close.
// Error: rotations 1e-6 rad, translations, scales and weights 1 ULP of the float keys' span, against double
// (tests/scene/test_animate.cpp).
Pose pose_scene(const Scene& scene, double time_s);

// Evaluates a channel at a time, in double.
//   time_s  as in pose_scene
// Returns one value for each float of a key. A rotation has unit length; where a spline passes through zero it is
// 0 0 0 1.
std::vector<double> channel_value(const Channel& channel, double time_s);

// Finds what the playing channels change.
// Returns a set of flags for each node; empty where nothing plays. kPlaceMoves: the node's transform or that of an
// ancestor; kShapeMoves: its morph weights.
inline constexpr char kPlaceMoves = 1, kShapeMoves = 2;
std::vector<char> moving_nodes(const Scene& scene);

}  // namespace shoal
