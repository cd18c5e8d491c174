// The parts of the scene `pond`. Each function adds a part to a builder at a level of detail, 1 the coarsest; a higher
// level never has fewer triangles.
#pragma once

#include <cstdint>

#include "scene/procedural/part_plan.h"

namespace shoal::pond {

// Layout in metres. The water's plane is y = 0; the centre of the pond is the origin.
inline constexpr float kLongX = 11.0f, kLongZ = 8.0f;  // half axes of the ellipse around which the shore varies
// Half size of the water's plane, whose edge lies under the banks.
inline constexpr float kWaterHalfX = 14.0f, kWaterHalfZ = 10.5f;
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

// Returns the distance of the shore from the centre in a unit direction.
float shore_m(Vec2f direction);
// Returns the height of the ground at a point: the bed below 0, then the banks, the meadow and the hills.
float ground_y(float x, float z);
// Returns the distance of a point from the centre divided by that of the shore; 1 on the shore.
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
