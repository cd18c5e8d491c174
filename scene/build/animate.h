// Where everything is at a time: node transforms and morph weights out of keyframes.
#pragma once

#include <vector>

#include "scene/build/transform.h"
#include "scene/scene.h"

namespace shoal {

// The channels that `--time` plays: those of the first animation, and of every further one that moves nothing that an
// earlier playing one moves (a figure's second walk does not mix with its first; nine cubes with an animation each all
// move). In the file's order.
struct PlayingChannels {
  std::vector<const Channel*> channels;
  std::vector<std::size_t> left_out;  // animations that do not play
};
PlayingChannels playing_channels(const Scene& scene);

struct Pose {
  std::vector<Affine> world_from_local;           // one a node, in double
  std::vector<std::vector<float>> morph_weights;  // one a node, empty where it has none
};

// The scene at a time. Nodes that nothing animates stay as they are, bit for bit.
//   scene   `locals` as long as `nodes`, or empty: then the nodes' own matrices are the answer
//   time_s  finite; channels clamp to their first and last key, they do not repeat
// Source: glTF 2.0 specification, 3.11 and appendix C (interpolation).
// Differs: slerp's angle is 2 atan2(|b - a|, |b + a|), which loses no digits where the keys are close.
// Error: rotations 1e-6 rad, translations, scales and weights 1 ULP of the float keys' span, against double
// (tests/scene/test_animate.cpp).
Pose pose_scene(const Scene& scene, double time_s);

// A channel's value at a time: `width` floats' worth, in double. Rotations are of unit length, or 0 0 0 1 where a
// spline passes through zero.
std::vector<double> channel_value(const Channel& channel, double time_s);

// What the playing channels change of each node: its place (by itself or with what it hangs from), its mesh's shape
// (morph weights), both or neither. Empty where nothing plays.
inline constexpr char kPlaceMoves = 1, kShapeMoves = 2;
std::vector<char> moving_nodes(const Scene& scene);

}  // namespace shoal
