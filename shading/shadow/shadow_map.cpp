#include "shading/shadow/shadow_map.h"

#include <algorithm>
#include <cmath>

#include "core/vec_lanes.h"
#include "raster/pass_bins.h"
#include "shading/shadow/shadow_pass.h"

namespace shoal {

namespace {

constexpr int kShadowTile = 128;      // texels; fixed, as the maps do not depend on --tile
constexpr int kBorderTexels = 4;      // empty ones on each side: points there are lit
constexpr float kOverlap_m = 0.001f;  // both parts reach this far beyond the plane, so that no seam opens at it

// Axes of the sun's view; they depend on its direction alone.
struct SunAxes {
  Vec3f right, up, forward;
};
SunAxes sun_axes(Vec3f direction) {
  const float x = std::fabs(direction.x), y = std::fabs(direction.y), z = std::fabs(direction.z);
  const Vec3f helper = y <= x && y <= z ? Vec3f{0, 1, 0} : x <= z ? Vec3f{1, 0, 0} : Vec3f{0, 0, 1};
  const Vec3f right = normalize(cross(direction, helper));
  return {right, cross(right, direction), direction};
}

Vec3f sheared(const SunBend& bend, Vec3f p) {
  const float depth_m = std::fmax(-dot(p - bend.origin, bend.normal), 0.0f);
  return p + bend.shear * depth_m;
}

// Extent of all casters along the axes, straight and as each plane shears them.
struct Extent {
  Vec3f lo, hi;
  bool empty = true;
  void add(const SunAxes& axes, Vec3f p) {
    const Vec3f q{dot(p, axes.right), dot(p, axes.up), dot(p, axes.forward)};
    lo = empty ? q : min(lo, q);
    hi = empty ? q : max(hi, q);
    empty = false;
  }
};
Extent extent_of(const std::vector<Meshlet>& meshlets, const std::vector<SunBend>& bends, const SunAxes& axes) {
  Extent extent;
  for (const Meshlet& meshlet : meshlets) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f lo = meshlet.bounds_min_world, hi = meshlet.bounds_max_world;
      const Vec3f p{(corner & 1) != 0 ? hi.x : lo.x, (corner & 2) != 0 ? hi.y : lo.y, (corner & 4) != 0 ? hi.z : lo.z};
      for (const SunBend& bend : bends) extent.add(axes, bend.bent ? sheared(bend, p) : p);
    }
  }
  return extent;
}

// The dense part of the scene across the sun's rays, and all of its water: a twentieth of the meshlets, at most, lies
// beyond it on any side.
Extent dense_part(const SunShadowIn& in, const Extent& whole, const SunAxes& axes) {
  constexpr float kPadding = 0.15f;  // of its width, on each side
  const std::vector<Meshlet>& meshlets = in.meshlets;
  const std::size_t few = meshlets.size() / 20;
  Extent part = whole;
  std::vector<float> places(meshlets.size());
  const auto middle = [&](Vec3f axis, float& lo, float& hi) {
    for (std::size_t c = 0; c < meshlets.size(); ++c)
      places[c] = dot((meshlets[c].bounds_min_world + meshlets[c].bounds_max_world) * 0.5f, axis);
    std::sort(places.begin(), places.end());
    lo = places[few], hi = places[places.size() - 1 - few];
  };
  middle(axes.right, part.lo.x, part.hi.x);
  middle(axes.up, part.lo.y, part.hi.y);
  for (const Vec3f p : in.water_outline) part.add(axes, p);
  const Vec3f span = part.hi - part.lo;
  const float pad = std::fmax(span.x, span.y) * kPadding;
  part.lo = max(part.lo - Vec3f{pad, pad, 0}, whole.lo);
  part.hi = min(part.hi + Vec3f{pad, pad, 0}, whole.hi);
  part.lo.z = whole.lo.z, part.hi.z = whole.hi.z;
  return part;
}

float width_of(const Extent& extent) { return std::fmax(extent.hi.x - extent.lo.x, extent.hi.y - extent.lo.y); }

// The sun's view of an extent, on a grid of texels that is fixed to the world's origin.
ShadowMap place_map(const Extent& extent, const SunAxes& axes, int size_px) {
  ShadowMap map;
  map.grid = make_frame_grid(size_px, size_px);
  // Up to the next sixteenth of its power of two: an animated scene's texels keep their size.
  const float widest = std::fmax(width_of(extent), 1e-3f);
  const float step = as_float(as_int(widest) & 0x7F800000) * 0.0625f;
  map.texel_m = std::ceil(widest / step) * step / static_cast<float>(size_px - 2 * kBorderTexels);
  const auto snapped = [&](float lo, float hi) {
    return std::floor((lo + hi) * 0.5f / map.texel_m + 0.5f) * map.texel_m;
  };
  const float range = extent.hi.z - extent.lo.z, margin = std::fmax(range * 0.01f, 1e-2f);
  Camera camera;
  camera.right_world = axes.right, camera.up_world = axes.up, camera.forward_world = axes.forward;
  camera.orthographic = true;
  camera.xmag_m = camera.ymag_m = map.texel_m * static_cast<float>(size_px) * 0.5f;
  camera.near_m = 0;
  camera.far_m = range + 2 * margin;
  camera.position_world = axes.right * snapped(extent.lo.x, extent.hi.x) + axes.up * snapped(extent.lo.y, extent.hi.y) +
                          axes.forward * (extent.lo.z - margin);
  map.view = make_view(camera, size_px, size_px, {0, 0});
  // Rounding of coordinates, and a twentieth of a texel; find_place accounts for slopes.
  map.bias = (0.05f * map.texel_m + 1e-6f * (width_of(extent) + range)) / camera.far_m;
  return map;
}

bool same_plane(const SunBend& a, const SunBend& b) {
  const auto equal = [](Vec3f u, Vec3f v) { return u.x == v.x && u.y == v.y && u.z == v.z; };
  return a.bent == b.bent && (!a.bent || (equal(a.normal, b.normal) && equal(a.shear, b.shear) &&
                                          std::fabs(dot(a.origin - b.origin, a.normal)) < 1e-5f));
}

// One bend for each map, the straight one first, and the map of each body.
std::vector<SunBend> collect_bends(const std::vector<SunBend>& of_bodies, std::vector<std::int32_t>& map_of_body) {
  std::vector<SunBend> bends(1);
  for (const SunBend& bend : of_bodies) {
    std::size_t at = 0;
    while (at < bends.size() && !same_plane(bends[at], bend)) ++at;
    if (at == bends.size() && at < kMaxSunMaps) bends.push_back(bend);
    map_of_body.push_back(at < bends.size() ? static_cast<std::int32_t>(at) : 0);
  }
  return bends;
}

// The materials as the sun's passes draw them.
struct Casters {
  std::vector<DrawState> draw_states;  // all double-sided
  std::vector<std::uint8_t> casts;     // 0: unlit or blended
};
Casters make_casters(const SunShadowIn& in) {
  const std::vector<Material> materials(in.view.materials, in.view.materials + in.material_count);
  Casters casters;
  casters.draw_states = draw_states(materials);
  for (DrawState& state : casters.draw_states) state.double_sided = true;
  for (const Material& m : materials)
    casters.casts.push_back(m.unlit || m.alpha_mode == AlphaMode::kBlend ? std::uint8_t{0} : std::uint8_t{1});
  return casters;
}

// The passes of a map: all of the scene, or what lies above the plane and what lies below it.
std::vector<ShadowPass> passes_of(const ShadowMap& map, const GeometryView& geometry, const Casters& casters) {
  ShadowPass whole;
  whole.geometry = geometry;
  whole.geometry.draw_states = casters.draw_states.data();
  whole.casts = casters.casts.data();
  whole.map = &map;
  whole.pass.width_px = whole.pass.height_px = map.grid.width_px;
  whole.pass.centre_px = map.view.centre_px;
  whole.pass.grid = make_bin_grid(map.grid.width_px, map.grid.height_px, kShadowTile);
  whole.pass.x_max = whole.pass.y_max = map.grid.width_px - 1;
  if (!map.bend.bent) return {whole};

  const float height = dot(map.bend.normal, map.bend.origin);
  std::vector<ShadowPass> passes(2, whole);
  passes[0].clipped = passes[1].clipped = true;
  passes[0].keep = {map.bend.normal, kOverlap_m - height};
  passes[1].keep = {-map.bend.normal, kOverlap_m + height};
  passes[1].sheared = true;
  return passes;
}

// Measures one row of cells. The nine taps that begin in a cell reach two texels beyond it, and the middle one is one
// texel from the others along either axis.
void measure_steepness(ShadowMap& map, int cell_row) {
  constexpr int kRows = kShadowCell + 2;
  const int size = map.grid.width_px, y0 = cell_row * kShadowCell;
  const std::size_t width = static_cast<std::size_t>(size);
  std::vector<float> texels(width * kRows), across(width + 2, 0.0f), down(width + 2, 0.0f);
  for (int y = 0; y < kRows; ++y) {
    const int row = std::min(y0 + y, size - 1);
    float* to = texels.data() + width * static_cast<std::size_t>(y);
    for (int x = 0; x < size; x += kBlockSize)
      std::copy_n(map.depth.data() + map.grid.slot(x, row), kBlockSize, to + x);
  }
  for (int y = 0; y < kRows; ++y) {
    const float* row = texels.data() + width * static_cast<std::size_t>(y);
    for (std::size_t x = 0; x + 1 < width; ++x) across[x] = std::max(across[x], std::fabs(row[x + 1] - row[x]));
    if (y + 1 == kRows) break;
    for (std::size_t x = 0; x < width; ++x) down[x] = std::max(down[x], std::fabs(row[x + width] - row[x]));
  }
  float* out = map.steepness.data() + static_cast<std::size_t>(cell_row) * (width / kShadowCell);
  for (std::size_t x = 0; x < width; x += kShadowCell) {
    float dx = 0, dy = 0;
    for (std::size_t i = x; i < x + kRows - 1; ++i) dx = std::max(dx, across[i]);
    for (std::size_t i = x; i < x + kRows; ++i) dy = std::max(dy, down[i]);
    out[x / kShadowCell] = (dx + dy) * 1.0001f + 1e-7f;  // rounding of the differences
  }
}

void draw_map(const SunShadowIn& in, const Casters& casters, ShadowMap& map, VisibilityBuffer& scratch,
              ThreadPool& pool, const ShadowKernels& kernels) {
  const std::vector<ShadowPass> passes = passes_of(map, in.view.geometry, casters);
  std::vector<PassBins> bins(passes.size());
  for (std::size_t i = 0; i < passes.size(); ++i) {
    PassBins& of_pass = bins[i] = make_bins(in.meshlets.size());
    pool.for_each(of_pass.work_items.size(), [&](std::size_t work_item, int) {
      const std::uint32_t first = static_cast<std::uint32_t>(work_item) * of_pass.meshlets_per_work_item;
      const std::uint32_t last = std::min(first + of_pass.meshlets_per_work_item, of_pass.meshlet_count);
      kernels.shadow_front_end({passes[i], first, last}, of_pass.work_items[work_item]);
    });
  }
  scratch.resize(map.grid);
  const BinGrid& grid = passes[0].pass.grid;
  const std::size_t tiles = static_cast<std::size_t>(grid.tiles_x) * static_cast<std::size_t>(grid.tiles_y);
  pool.for_each(tiles, [&](std::size_t tile, int) {
    kernels.draw_shadow_tile({in.view, passes, bins, tile}, scratch);
  });
  map.depth = std::move(scratch.depth);
  scratch.depth = AlignedArray<float>();
  const std::size_t cells = static_cast<std::size_t>(map.grid.width_px / kShadowCell);
  map.steepness.resize(cells * cells);
  pool.for_each(cells, [&](std::size_t row, int) { measure_steepness(map, static_cast<int>(row)); });
}

}  // namespace

void build_shadows(const SunShadowIn& in, SunShadows& out, ThreadPool& pool, const ShadowKernels& kernels) {
  out = SunShadows();
  if (in.view.lighting->directional.empty()) return;
  const SunAxes axes = sun_axes(in.view.lighting->directional[0].direction_world);
  const std::vector<SunBend> bends = collect_bends(in.bends, out.map_of_body);
  const Extent extent = extent_of(in.meshlets, bends, axes);
  if (extent.empty) return;

  std::vector<ShadowMap> levels;
  const Extent dense = dense_part(in, extent, axes);
  const bool two_levels = width_of(dense) * 2 < width_of(extent);
  levels.push_back(place_map(two_levels ? dense : extent, axes, in.size_px));
  if (two_levels) levels.push_back(place_map(extent, axes, in.size_px / 2));

  const Casters casters = make_casters(in);
  VisibilityBuffer scratch;
  out.maps.resize(bends.size());
  for (std::size_t i = 0; i < bends.size(); ++i) {
    for (const ShadowMap& level : levels) {
      ShadowMap map;
      map.view = level.view, map.grid = level.grid, map.texel_m = level.texel_m, map.bias = level.bias;
      map.bend = bends[i];
      draw_map(in, casters, map, scratch, pool, kernels);
      out.maps[i].levels.push_back(std::move(map));
    }
  }
}

}  // namespace shoal
