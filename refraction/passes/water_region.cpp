#include "refraction/passes/water_region.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include "water/exact_ray.h"

namespace shoal {

namespace {

// Geometry is clipped this far beyond the plane, so that no seam opens between direct and refracted edges.
constexpr float kOverlap_m = 0.02f;
// Beyond any scene: nothing is clipped.
constexpr float kEverything_m = 1e30f;

// Between the plane and displaced waves there is geometry on either side.
float overlap_m(const WaterPass& water) {
  return kOverlap_m + (is_displaced(*water.body, water.surface) ? water.surface->height_bound_m : 0.0f);
}

// Seen along the normal, is p inside of the triangle (either orientation)?
bool inside_triangle(Vec3f p, Vec3f a, Vec3f b, Vec3f c, Vec3f normal) {
  const float ab = dot(cross(b - a, p - a), normal), bc = dot(cross(c - b, p - b), normal),
              ca = dot(cross(a - c, p - c), normal);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

// Where a point is, by the surface as it is drawn.
struct Place {
  bool over_body;  // seen along the normal, inside of the outline
  float above_m;   // the surface
  float above_plane_m;
};
//   surface  null: flat
Place place_of(const WaterBody& body, const WaterSurface* surface, Vec3f p) {
  const Vec3f at = on_body<float>(body, p);
  Place place{false, at.y, at.y};
  for (std::size_t i = 0; i + 2 < body.outline.size(); i += 3)
    place.over_body =
        place.over_body || inside_triangle(p, body.outline[i], body.outline[i + 1], body.outline[i + 2], body.normal);
  if (is_displaced(body, surface)) place.above_m = at.y - surface_at<float>(*surface, at.x, at.z).height_m;
  return place;
}

// The body whose plane the passes are drawn with. Where waves put the eye on the other side of their plane, the plane
// is moved past the eye: the passes must be those of the side that it is on.
WaterBody with_eye_on_its_side(const WaterBody& body, const Place& eye) {
  constexpr float kPast_m = 0.01f;
  WaterBody moved = body;
  const bool below = eye.above_m < 0.0f;
  if (eye.over_body && below != (eye.above_plane_m < 0.0f))
    moved.origin = body.origin + body.normal * (eye.above_plane_m + (below ? kPast_m : -kPast_m));
  return moved;
}

}  // namespace

void place_water(FrameData& f, const MethodKernels& method) {
  const std::vector<WaterBody>& bodies = f.scene->waters;
  f.water.resize(bodies.size());
  f.eye_in_water = -1;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    WaterPass& w = f.water[b];
    w = WaterPass{};
    w.body = &bodies[b];
    w.index = static_cast<std::int32_t>(b);
    w.surface = bodies[b].surface.kind == SurfaceKind::kFlat ? nullptr : &f.surfaces[b];
    w.near_m = f.view.camera.near_m;
    w.pixel = pixel_ray_differential<float>(f.view);
    const Place eye = place_of(bodies[b], w.surface, f.view.camera.position_world);
    const bool displaced = is_displaced(bodies[b], w.surface);
    const WaterBody plane = displaced ? with_eye_on_its_side(bodies[b], eye) : WaterBody();
    w.optics = make_broad_phase(displaced ? plane : bodies[b], f.view);
    w.map = method.map(displaced ? plane : bodies[b], f.view);
    const WaterSide side = eye_side(w.optics);
    w.mirrors = f.settings.reflections == Reflections::kScene || always_mirrors(w.optics.eye_below, side.eta);
    w.keep = {w.map.far_normal, overlap_m(w) - dot(w.map.far_normal, w.map.plane_origin)};
    if (method.whole_scene) w.keep.offset_m = kEverything_m;
    w.looks_far = method.light_layer != nullptr;
    const bool in_water = eye.over_body && eye.above_m < 0.0f && eye.above_plane_m > -bodies[b].depth_m;
    if (f.eye_in_water < 0 && in_water) f.eye_in_water = w.index;
  }
}

bool any_displaced(const FrameData& f) {
  return std::any_of(f.water.begin(), f.water.end(),
                     [](const WaterPass& w) { return is_displaced(*w.body, w.surface); });
}

// What of the layers is drawn for a body that shows in these regions of the frame, first to last: those, or, where
// waves bend rays away or the method looks into a lit layer, all.
struct RegionBox {
  int x0, y0, x1, y1;
};
static void draw_layers_at(FrameData& f, WaterPass& water, RegionBox box) {
  const LayerGrid& layers = f.layers;
  std::vector<std::uint8_t>& region = f.layer_regions;
  if (water.looks_far) {
    std::fill(region.begin(), region.end(), std::uint8_t{1});
    box = {0, 0, layers.grid.regions_x - 1, layers.grid.regions_y - 1};
  } else {
    const int margin = layers.margin_px / kRegionSize;
    std::fill(region.begin(), region.end(), std::uint8_t{0});
    for (std::size_t r = 0; r < f.region_of_body.size(); ++r) region[layers.region(f.grid, r)] = f.region_of_body[r];
    box = {box.x0 + margin, box.y0 + margin, box.x1 + margin, box.y1 + margin};
  }
  std::fill(f.tile_active.begin(), f.tile_active.end(), std::uint8_t{0});
  const BinGrid& grid = layers.tiles;
  const int nx = layers.grid.regions_x, ny = layers.grid.regions_y;
  for (int ty = 0; ty < grid.tiles_y; ++ty)
    for (int tx = 0; tx < grid.tiles_x; ++tx) {
      const int rx0 = (tx << grid.tile_shift) / kRegionSize, ry0 = (ty << grid.tile_shift) / kRegionSize;
      const int rx1 = std::min((((tx + 1) << grid.tile_shift) - 1) / kRegionSize, nx - 1);
      const int ry1 = std::min((((ty + 1) << grid.tile_shift) - 1) / kRegionSize, ny - 1);
      std::uint8_t active = 0;
      for (int y = ry0; y <= ry1; ++y)
        for (int x = rx0; x <= rx1; ++x)
          active = static_cast<std::uint8_t>(active | region[static_cast<std::size_t>(y * nx + x)]);
      f.tile_active[static_cast<std::size_t>(ty * grid.tiles_x + tx)] = active;
    }

  const int margin = layers.margin_px;
  const float shift = static_cast<float>(margin);
  PassSettings& pass = water.pass;
  pass = f.direct_pass;
  pass.width_px = layers.grid.width_px, pass.height_px = layers.grid.height_px;
  pass.centre_px = {pass.centre_px.x + shift, pass.centre_px.y + shift};
  pass.grid = grid;
  pass.x_min = box.x0 * kRegionSize, pass.y_min = box.y0 * kRegionSize;
  pass.x_max = std::min((box.x1 + 1) * kRegionSize, layers.grid.width_px) - 1;
  pass.y_max = std::min((box.y1 + 1) * kRegionSize, layers.grid.height_px) - 1;
  pass.tile_active = f.tile_active.data();
  water.frustum =
      make_frustum(f.view, pass.x_min - margin, pass.y_min - margin, pass.x_max - margin, pass.y_max - margin);
}

LayerGrid make_layer_grid(const FrameGrid& frame, int tile_px, int margin_px) {
  LayerGrid layers;
  layers.margin_px = margin_px;
  layers.grid = make_frame_grid(frame.width_px + 2 * margin_px, frame.height_px + 2 * margin_px);
  layers.tiles = make_bin_grid(layers.grid.width_px, layers.grid.height_px, tile_px);
  layers.regions = make_bin_grid(layers.grid.width_px, layers.grid.height_px, kRegionSize);
  return layers;
}

bool find_region(FrameData& f, const FrameKernels& kernels, WaterPass& water, ThreadPool& pool) {
  const int nx = f.grid.regions_x, ny = f.grid.regions_y;
  const std::size_t regions = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
  std::vector<std::uint8_t> flags(regions);
  std::atomic<std::uint64_t> pixels{0};
  pool.for_each(regions, [&](std::size_t region, int) {
    std::uint32_t count = 0;
    flags[region] = kernels.water_in_region(f, water.index, region, count);
    pixels.fetch_add(count, std::memory_order_relaxed);
  });
  f.water_pixels += pixels.load();
  if (pixels.load() == 0) return false;

  // The narrow phase looks one pixel beyond: a region whose side shows water reaches into its neighbour.
  std::vector<std::uint8_t>& region = f.region_of_body;
  std::fill(region.begin(), region.end(), std::uint8_t{0});
  int x0 = nx, y0 = ny, x1 = -1, y1 = -1;
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      const int has = flags[static_cast<std::size_t>(y * nx + x)];
      if (has == 0) continue;
      const int left = (has & 2) != 0 ? 1 : 0, right = (has & 4) != 0 ? 1 : 0;
      const int top = (has & 8) != 0 ? 1 : 0, bottom = (has & 16) != 0 ? 1 : 0;
      for (int j = std::max(y - top, 0); j <= std::min(y + bottom, ny - 1); ++j)
        for (int i = std::max(x - left, 0); i <= std::min(x + right, nx - 1); ++i) {
          region[static_cast<std::size_t>(j * nx + i)] = 1;
          x0 = std::min(x0, i), y0 = std::min(y0, j), x1 = std::max(x1, i), y1 = std::max(y1, j);
        }
    }
  draw_layers_at(f, water, {x0, y0, x1, y1});
  return true;
}

WaterPass mirrored_pass(const WaterPass& refracted) {
  WaterPass w = refracted;
  w.mirrored = true;
  // The eye's side of the plane is what it mirrors.
  const Vec3f normal = -w.optics.far_normal;
  w.keep = {normal, overlap_m(w) - dot(normal, w.optics.plane_origin)};
  w.pass.flip_facing = true;
  return w;
}

void count_capped(FrameData& f) {
  for (const WorkItemBins& work_item : f.bins.work_items) f.subdivision_capped += work_item.subdivision_capped;
}

}  // namespace shoal
