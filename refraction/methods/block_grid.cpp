// block-grid: refracted rays at the corners of square blocks of pixels only, followed to the floor's plane; between
// them the floor's coordinates are interpolated in the screen. Objects in the water are not seen through it.
//
// Source  Champandard 1999, "Rendering Raytraced Refraction with 3D Hardware".
// Differs Bilinear in a block, where his rectangles were drawn as two triangles by the hardware. The floor's point is
//         interpolated rather than its texture coordinates, which are linear in it where the floor has one mapping.
//         Waves are the scene's; his are the surface `ripples` with four sources on a grid of 64 x 64 normals.
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

enum Option { kBlock, kOptionCount };
constexpr MethodOption kOptions[kOptionCount] = {
    {"block", "8", "pixels a side of the blocks whose corners are traced", MethodOption::Kind::kInt, 1, 32},
};

struct BlockGrid : TrueRays {
  static constexpr bool kMisses = true;  // what is not floor is not shown

  // From the crossing to the point that was found.
  SHOAL_INLINE static WaterRays<WideF> pixel_rays(const FrameData& f, const Block& block, const WaterPass& water,
                                                  const Ray<WideF>& view_ray,
                                                  const RayDifferential<WideF>& differential) {
    WaterRays<WideF> r = rays(water, view_ray, differential);
    const Vec3<WideF> aim = {WideF::load(f.hits.aim_x.data() + block.offset),
                             WideF::load(f.hits.aim_y.data() + block.offset),
                             WideF::load(f.hits.aim_z.data() + block.offset)};
    const Vec3<WideF> way = aim - r.refracted.origin_world;
    const WideM aimed =
        is_triangle(WideI::load(f.hits.refracted_id.data() + block.offset)) & (dot(way, way) > WideF(1e-12f));
    const Vec3<WideF> direction = normalize(select<WideF>(aimed, way, r.refracted.direction_world));
    r.refracted.direction_world = select<WideF>(aimed, direction, r.refracted.direction_world);
    return r;
  }
};
using Stages = MethodStages<BlockGrid>;

// The corners that a region's pixels lie between.
struct Corners {
  static constexpr int kMost = kRegionSize + 1, kStride = kMost + 15;
  int first_x, first_y, count_x, count_y;  // in blocks; corners each way
  float x_m[kMost * kStride], z_m[kMost * kStride];
  std::int32_t found[kMost * kStride];  // 1 or 0
};

// Where the corners' refracted rays meet the floor's plane, along the body's axes.
__attribute__((noinline)) void trace_corners(const FrameData& f, const WaterPass& water, float floor_m, int block_px,
                                             Corners& c) {
  const WaterBody& body = *water.body;
  const Vec3<WideF> axis_x = broadcast<WideF>(body.axis_x), axis_z = broadcast<WideF>(body.axis_z),
                    normal = broadcast<WideF>(body.normal), origin = broadcast<WideF>(body.origin);
  const float size = static_cast<float>(block_px);
  for (int j = 0; j < c.count_y; ++j)
    for (int i = 0; i < c.count_x; i += 16) {
      alignas(64) float lane_number[16];
      for (int k = 0; k < 16; ++k) lane_number[k] = static_cast<float>(c.first_x + i + k);
      const Ray<WideF> view_ray =
          pixel_ray(f.view, WideF::load(lane_number) * WideF(size), WideF(static_cast<float>(c.first_y + j) * size));
      const ExactRay<WideF> at = exact_ray(eye_side(water), view_ray);
      const Vec3<WideF> from = at.crossing_world - origin;
      const WideF fall = dot(at.refracted, normal), way = WideF(floor_m) - dot(from, normal);
      const WideM falls = at.crosses & at.transmitted & (fall < WideF(0.0f));
      const WideF t = way / select(falls, fall, WideF(-1.0f));
      const Vec3<WideF> p = from + at.refracted * t;
      const WideF x = dot(p, axis_x), z = dot(p, axis_z);
      const WideM found = falls & (t >= WideF(0.0f)) & (abs(x) < WideF(1e6f)) & (abs(z) < WideF(1e6f));
      alignas(64) float x_of[16], z_of[16];
      alignas(64) std::int32_t found_of[16];
      select(found, x, WideF(0.0f)).store(x_of), select(found, z, WideF(0.0f)).store(z_of);
      select(found, WideI(1), WideI(0)).store(found_of);
      for (int k = 0; k < 16 && i + k < c.count_x; ++k) {
        const int at_corner = j * Corners::kStride + i + k;
        c.x_m[at_corner] = x_of[k], c.z_m[at_corner] = z_of[k], c.found[at_corner] = found_of[k];
      }
    }
}

struct FloorPoint {
  WideF x_m, z_m;
  WideM found;
};
FloorPoint interpolate(const Corners& c, const Block& block, int block_px) {
  const WideF inv(1.0f / static_cast<float>(block_px));
  const WideF x = (to_float(WideI(block.x_px) + block_x()) + WideF(0.5f)) * inv,
              y = (to_float(WideI(block.y_px) + block_y()) + WideF(0.5f)) * inv;
  // A pixel's centre is never on a corner, so that rounding cannot take it to another block.
  const WideF column = floor(x), row = floor(y), u = x - column, v = y - row;
  const WideI i = min(max(to_int_trunc(column) - WideI(c.first_x), WideI(0)), WideI(c.count_x - 2)),
              j = min(max(to_int_trunc(row) - WideI(c.first_y), WideI(0)), WideI(c.count_y - 2));
  const WideI at = j * WideI(Corners::kStride) + i;
  const WideI right = at + WideI(1), below = at + WideI(Corners::kStride), last = below + WideI(1);
  const auto mix = [&](const float* values) SHOAL_LAMBDA {
    const WideF top = gather(values, at) * (WideF(1.0f) - u) + gather(values, right) * u;
    const WideF bottom = gather(values, below) * (WideF(1.0f) - u) + gather(values, last) * u;
    return top * (WideF(1.0f) - v) + bottom * v;
  };
  const WideI all_found = gather(c.found, at) & gather(c.found, right) & gather(c.found, below) & gather(c.found, last);
  return {mix(c.x_m), mix(c.z_m), all_found != WideI(0)};
}

WideI floor_ids(const Floor& floor, const FloorPoint& p, WideM lanes) {
  alignas(64) float x[16], z[16];
  alignas(64) std::int32_t ids[16];
  p.x_m.store(x), p.z_m.store(z);
  const std::uint32_t bits = to_bits(lanes & p.found);
  for (int k = 0; k < 16; ++k) ids[k] = ((bits >> k) & 1u) != 0 ? floor.at(x[k], z[k]) : kNoId;
  return WideI::load(ids);
}

void narrow(FrameData& f, const WaterPass& water, std::size_t region) {
  const int block_px = static_cast<int>(f.method_option[kBlock]);
  const Floor& floor = f.floors[static_cast<std::size_t>(water.index)];
  const WaterBody& body = *water.body;
  const RayDifferential<WideF> differential = pixel_ray_differential<WideF>(f.view);
  Corners corners;
  bool traced = false;
  NarrowPhase phase(f, water, region);
  for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    const WideM here = water_lanes(f, water, block);
    if (none(here)) return;
    if (!traced) {
      const int x0 = static_cast<int>(region % static_cast<std::size_t>(f.grid.regions_x)) * kRegionSize;
      const int y0 = static_cast<int>(region / static_cast<std::size_t>(f.grid.regions_x)) * kRegionSize;
      corners.first_x = x0 / block_px, corners.first_y = y0 / block_px;
      corners.count_x = (x0 + kRegionSize - 1) / block_px - corners.first_x + 2;
      corners.count_y = (y0 + kRegionSize - 1) / block_px - corners.first_y + 2;
      trace_corners(f, water, floor.height_m, block_px, corners);
      traced = true;
    }
    const WaterRays<WideF> rays = TrueRays::rays(water, block_rays(f.view, block), differential);
    const FloorPoint p = interpolate(corners, block, block_px);
    const WideI id = floor_ids(floor, p, here & rays.at_surface.transmitted);
    const Vec3<WideF> aim = broadcast<WideF>(body.origin + body.normal * floor.height_m) +
                            broadcast<WideF>(body.axis_x) * p.x_m + broadcast<WideF>(body.axis_z) * p.z_m;
    store_masked(f.hits.refracted_id.data() + block.offset, id, here);
    shade_detail::put3(f.hits.aim_x, f.hits.aim_y, f.hits.aim_z, block.offset, aim, here);
    if (f.blended.any()) note_layer(f, water, false, id, aim, block);
    phase.mirror(block, rays, here);
  });
}

void prepare(FrameData& f, ThreadPool&, const Camera*) {
  f.floors.clear();
  for (const WaterBody& body : f.scene->waters) f.floors.push_back(find_floor(*f.scene, body));
  for (auto* plane : {&f.hits.aim_x, &f.hits.aim_y, &f.hits.aim_z}) plane->resize(f.grid.pixel_slots());
}

}  // namespace

Method block_grid() {
  return {"block-grid",
          "rays at block corners, the floor's coordinates interpolated between; for water over a level floor",
          "Champandard 1999",
          Stages::kernels_without_layer(&narrow, &prepare),
          kOptions,
          kOptionCount};
}

}  // namespace shoal::inline SHOAL_ISA_NS
