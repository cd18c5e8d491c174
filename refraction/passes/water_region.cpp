#include "refraction/passes/water_region.h"

#include <algorithm>

#include "raster/ray_triangle.h"
#include "water/nearest_water.h"

namespace shoal {

namespace {

// Geometry is clipped this far beyond the plane, so that no seam opens between direct and refracted edges.
constexpr float kOverlap_m = 0.02f;
// Beyond any scene: nothing is clipped.
constexpr float kEverything_m = 1e30f;

// Between the plane and displaced waves there is geometry on either side.
float overlap_m(const WaterOptics& optics) {
  return kOverlap_m + (is_displaced(optics) ? optics.surface()->height_bound_m : 0.0f);
}

// Where the eye is, by the surface as it is drawn.
struct EyePlace {
  bool over_body;  // seen along the normal, inside of the outline
  float above_m;   // the surface
  float above_plane_m;
};
EyePlace place_of(const PlacedWater& water, Vec3f eye) {
  const WaterBody& body = *water.body;
  const Vec3f at = on_body<float>(body, eye);
  EyePlace place{in_outline<float>(body, eye), at.y, at.y};
  if (is_displaced(body, water.surface)) place.above_m = at.y - surface_at<float>(*water.surface, at.x, at.z).height_m;
  return place;
}

// The body whose plane the passes are drawn with. Where waves put the eye on the other side of their plane, the plane
// is moved past the eye, because the passes must be those of the eye's side.
WaterBody with_eye_on_its_side(const WaterBody& body, const EyePlace& eye) {
  constexpr float kPast_m = 0.01f;
  WaterBody moved = body;
  const bool below = eye.above_m < 0.0f;
  if (eye.over_body && below != (eye.above_plane_m < 0.0f))
    moved.origin = body.origin + body.normal * (eye.above_plane_m + (below ? kPast_m : -kPast_m));
  return moved;
}

}  // namespace

void place_water(const PlaceWaterIn& in, const PlaceWaterOut& out) {
  out.optics.clear();
  out.eye_in_water = -1;
  for (const PlacedWater& water : in.water) {
    const WaterBody& body = *water.body;
    const EyePlace eye = place_of(water, in.view.camera.position_world);
    const bool displaced = is_displaced(body, water.surface);
    const WaterBody plane = displaced ? with_eye_on_its_side(body, eye) : WaterBody();
    WaterOptics optics;
    optics.water = water;
    optics.exact = make_broad_phase(displaced ? plane : body, in.view);
    optics.map = in.map(displaced ? plane : body, in.view);
    optics.near_m = in.view.camera.near_m;
    optics.pixel = pixel_ray_differential<float>(in.view);
    const bool total = always_reflects_scene(optics.exact.eye_below, eye_side(optics.exact).eta);
    optics.reflections = in.reflections == Reflections::kEnvironment && total ? in.total : in.reflections;
    optics.whole_scene = in.whole_scene;
    out.optics.push_back(optics);
    const bool in_water = eye.over_body && eye.above_m < 0.0f && eye.above_plane_m > -body.depth_m;
    if (out.eye_in_water < 0 && in_water) out.eye_in_water = water.index;
  }
}

bool any_displaced(const std::vector<WaterOptics>& water) {
  return std::any_of(water.begin(), water.end(), [](const WaterOptics& w) { return is_displaced(w); });
}

namespace {

// Regions of a grid, first to last.
struct RegionBox {
  int x0, y0, x1, y1;
};

// Marks the frame's regions that show a body, and those beyond a side that shows it: the narrow phase reads one pixel
// beyond each water pixel.
RegionBox mark_regions(const FrameGrid& frame, const std::vector<WaterCount>& counts,
                       std::vector<std::uint8_t>& of_body) {
  const int nx = frame.regions_x, ny = frame.regions_y;
  std::fill(of_body.begin(), of_body.end(), std::uint8_t{0});
  RegionBox box{nx, ny, -1, -1};
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      const int has = counts[static_cast<std::size_t>(y * nx + x)].flags;
      if (has == 0) continue;
      const int left = (has & 2) != 0 ? 1 : 0, right = (has & 4) != 0 ? 1 : 0;
      const int top = (has & 8) != 0 ? 1 : 0, bottom = (has & 16) != 0 ? 1 : 0;
      for (int j = std::max(y - top, 0); j <= std::min(y + bottom, ny - 1); ++j)
        for (int i = std::max(x - left, 0); i <= std::min(x + right, nx - 1); ++i) {
          of_body[static_cast<std::size_t>(j * nx + i)] = 1;
          box = {std::min(box.x0, i), std::min(box.y0, j), std::max(box.x1, i), std::max(box.y1, j)};
        }
    }
  return box;
}

// Marks the layers' regions that a body's own regions and those around them are.
RegionBox mark_layer(const FrameGrids& grids, const std::vector<std::uint8_t>& of_body, const RegionBox& box,
                     int around, std::vector<std::int32_t>& layer) {
  const LayerGrid& layers = grids.layers;
  const int margin = layers.margin_px / kRegionSize, nx = layers.grid.regions_x, ny = layers.grid.regions_y;
  std::fill(layer.begin(), layer.end(), 0);
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x) {
      if (of_body[static_cast<std::size_t>(y * grids.frame.regions_x + x)] == 0) continue;
      for (int j = std::max(y + margin - around, 0); j <= std::min(y + margin + around, ny - 1); ++j)
        for (int i = std::max(x + margin - around, 0); i <= std::min(x + margin + around, nx - 1); ++i)
          layer[static_cast<std::size_t>(j * nx + i)] = 1;
    }
  return {std::max(box.x0 + margin - around, 0), std::max(box.y0 + margin - around, 0),
          std::min(box.x1 + margin + around, nx - 1), std::min(box.y1 + margin + around, ny - 1)};
}

}  // namespace

bool tile_overlaps(const LayerGrid& layers, const std::vector<std::int32_t>& regions, std::size_t tile) {
  const BinGrid& grid = layers.tiles;
  const int nx = layers.grid.regions_x, ny = layers.grid.regions_y;
  const int tx = static_cast<int>(tile) % grid.tiles_x, ty = static_cast<int>(tile) / grid.tiles_x;
  const int x1 = std::min((((tx + 1) << grid.tile_shift) - 1) / kRegionSize, nx - 1);
  const int y1 = std::min((((ty + 1) << grid.tile_shift) - 1) / kRegionSize, ny - 1);
  for (int y = (ty << grid.tile_shift) / kRegionSize; y <= y1; ++y)
    for (int x = (tx << grid.tile_shift) / kRegionSize; x <= x1; ++x)
      if (regions[static_cast<std::size_t>(y * nx + x)] != 0) return true;
  return false;
}

std::uint64_t find_region(const FindRegionIn& in, const FindRegionOut& out) {
  std::uint64_t pixels = 0;
  for (const WaterCount& count : in.counts) pixels += count.pixels;
  if (pixels == 0) return 0;

  const LayerGrid& layers = in.grids.layers;
  WaterRegions& regions = out.regions;
  RegionBox box = mark_regions(in.grids.frame, in.counts, regions.of_body);
  if (in.whole_layer) {
    std::fill(regions.layers.drawn.begin(), regions.layers.drawn.end(), 1);
    box = {0, 0, layers.grid.regions_x - 1, layers.grid.regions_y - 1};
  } else {
    box = mark_layer(in.grids, regions.of_body, box, in.widened, regions.layers.drawn);
  }
  for (std::size_t tile = 0; tile < regions.tile_active.size(); ++tile)
    regions.tile_active[tile] = tile_overlaps(layers, regions.layers.drawn, tile) ? 1 : 0;

  const int margin = layers.margin_px;
  const float shift = static_cast<float>(margin);
  WaterPass& water = out.refracted;
  water = WaterPass{};
  water.optics = &in.optics;
  PassSettings& pass = water.pass;
  pass = in.view.direct_pass;
  pass.width_px = layers.grid.width_px, pass.height_px = layers.grid.height_px;
  pass.centre_px = {pass.centre_px.x + shift, pass.centre_px.y + shift};
  pass.grid = layers.tiles;
  pass.x_min = box.x0 * kRegionSize, pass.y_min = box.y0 * kRegionSize;
  pass.x_max = std::min((box.x1 + 1) * kRegionSize, layers.grid.width_px) - 1;
  pass.y_max = std::min((box.y1 + 1) * kRegionSize, layers.grid.height_px) - 1;
  pass.tile_active = regions.tile_active.data();
  water.frustum =
      make_frustum(in.view.view, pass.x_min - margin, pass.y_min - margin, pass.x_max - margin, pass.y_max - margin);
  const BroadPhase& map = in.optics.map;
  water.clip_plane = {map.far_normal, overlap_m(in.optics) - dot(map.far_normal, map.plane_origin)};
  if (in.optics.whole_scene) water.clip_plane.offset_m = kEverything_m;
  return pixels;
}

void find_behind_regions(const LayerGrid& layers, const std::vector<std::int32_t>& drawn, const EdgeMap& edges,
                         std::vector<std::int32_t>& behind) {
  constexpr int kReach_px = 32, kEnd_px = kRegionSize - 1 + kReach_px;
  const int nx = layers.grid.regions_x;
  for (std::size_t r = 0; r < drawn.size(); ++r) {
    const int x = static_cast<int>(r) % nx * kRegionSize, y = static_cast<int>(r) / nx * kRegionSize;
    const bool near = edges.any_within(x - kReach_px, y - kReach_px, x + kEnd_px, y + kEnd_px);
    behind[r] = drawn[r] != 0 && near ? 1 : 0;
  }
}

WaterPass reflected_pass(const WaterPass& refracted) {
  WaterPass w = refracted;
  w.kind = WaterPassKind::kReflected;
  const Vec3f normal = -w.optics->exact.far_normal;
  w.clip_plane = {normal, overlap_m(*w.optics) - dot(normal, w.optics->exact.plane_origin)};
  w.pass.flip_facing = true;
  return w;
}

}  // namespace shoal
