// The parts of the scene `pool`. Each function adds a part to a builder at a level of detail, 1 the coarsest; a higher
// level never has fewer triangles.
#pragma once

#include <cstdint>

#include "scene/procedural/mesh_builder.h"
#include "scene/procedural/part_plan.h"

namespace shoal::pool {

// Layout in metres. The water's plane is y = 0; the basin is centred on the origin and shallow at -x.
inline constexpr float kHalfX = 5.0f, kHalfZ = 2.5f;
inline constexpr float kShallow = 1.2f, kDeep = 2.2f;
inline constexpr float kCopingTop = 0.12f, kDeckY = 0.10f, kBandBottom = -0.15f;
inline constexpr float kCopingOut = 0.36f;
inline constexpr float kDeckX = 10.0f, kDeckBack = -8.6f, kDeckFront = 8.5f;
inline constexpr float kArcadeFront = -5.9f, kArcadeBack = -6.3f, kBay = 3.0f;
inline constexpr int kBays = 6;

inline float floor_y(float x) { return -mix(kShallow, kDeep, (x + kHalfX) / (2 * kHalfX)); }

enum Mat : std::uint8_t {
  kTiles,
  kLane,
  kBand,
  kCoping,
  kPavers,
  kStucco,
  kOchre,
  kRoof,
  kMarble,
  kWood,
  kShutter,
  kGardenWall,
  kGlass,
  kChrome,
  kBall,
  kRing,
  kDiveRing,
  kCushion,
  kAwning,
  kTerracotta,
  kFoliage,
  kCypress,
  kOlive,
  kBlossom,
  kGrass,
  kMatCount
};

Materials make_materials();

void basin(PartBuilder& b, int level);
void steps(PartBuilder& b, int level);
void coping(PartBuilder& b, int level);
void deck(PartBuilder& b, int level);

void ladder(PartBuilder& b, int level);
template <int kWhich>
void ball(PartBuilder& b, int level);
template <int kWhich>
void ring(PartBuilder& b, int level);
void lounger(PartBuilder& b, int level);  // at the origin, its foot towards +z
void parasol(PartBuilder& b, int level);  // at the origin

void column(PartBuilder& b, int level);  // at the origin, its top at the arches' spring
void arcade(PartBuilder& b, int level);
void house(PartBuilder& b, int level);
void roof(PartBuilder& b, int level);
void garden_walls(PartBuilder& b, int level);

void pot(PartBuilder& b, int level);  // with a clipped ball of box; at the origin
void hedges(PartBuilder& b, int level);
void cypress(PartBuilder& b, int level);  // at the origin
void olive(PartBuilder& b, int level);    // a tree at the origin
void blossoms(PartBuilder& b, int level);
void hills(PartBuilder& b, int level);  // level is about the quads

}  // namespace shoal::pool
