// The pieces of the `pond` scene. Each part adds itself to a builder at a level of detail, 1 the coarsest; more levels
// never mean fewer triangles.
#pragma once

#include <cstdint>

#include "scene/procedural/part_plan.h"

namespace shoal::pond {

// Layout, metres. The water is y = 0; the pond's middle is the origin.
inline constexpr float kLongX = 11.0f, kLongZ = 8.0f;  // half axes of the ellipse that its shore wanders about
inline constexpr float kWaterHalfX = 14.0f, kWaterHalfZ = 10.5f;  // the plane's half size: its edge is under the banks
inline constexpr float kDeep = 2.1f, kLowest = -2.6f;

enum Mat : std::uint8_t {
  kDirt,
  kVerge,
  kMeadow,
  kRock,
  kBluePot,
  kGreenPot,
  kShaft,
  kHead,
  kFletching,
  kReed,
  kCattail,
  kGrass,
  kFlower,
  kLeaves,
  kPineLeaves,
  kBark,
  kPlank,
  kMatCount
};

// Distance of the shore from the middle, towards a unit direction.
float shore_m(Vec2f direction);
// Height of the ground at a place: the bed below 0, then the banks, the meadow and the hills.
float ground_y(float x, float z);
// Of a place: its distance from the middle over the shore's; 1 on the shore.
float shore_share(float x, float z);

void terrain(PartBuilder& b, int level);  // level is about the quads

void blue_pot(PartBuilder& b, int level);  // at the origin, standing
void green_pot(PartBuilder& b, int level);
void arrow(PartBuilder& b, int level);    // at the origin, its point down, the shaft along y
void boulder(PartBuilder& b, int level);  // at the origin, about one across
void slab(PartBuilder& b, int level);     // the same, flat
void jetty(PartBuilder& b, int level);

void reeds(PartBuilder& b, int level);  // a clump at the origin
void grass(PartBuilder& b, int level);  // tufts round the shore, more with each level
void bush(PartBuilder& b, int level);   // at the origin
void tree(PartBuilder& b, int level);   // at the origin
void pine(PartBuilder& b, int level);   // at the origin

}  // namespace shoal::pond
