// block-grid: refracted rays at the corners of square blocks of pixels only, followed to the floor's plane; between
// them the floor's coordinates are interpolated in the screen. Objects in the water are not seen through it.
//
// Source  Champandard 1999, "Rendering Raytraced Refraction with 3D Hardware".
// Differs Bilinear in a block, where his rectangles were drawn as two triangles by the hardware. The floor's point is
//         interpolated rather than its texture coordinates, which are linear in it where the floor has one mapping.
//         Waves are the scene's; his are the surface `ripples` with four sources on a grid of 64 x 64 normals.
#include "refraction/field/floor.h"
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct Floors : MethodData {
  std::vector<Floor> of_body;
};

// The corners that a region's pixels lie between.
struct Corners {
  static constexpr int kMax = kRegionSize + 1, kStride = kMax + 15;
  int first_x, first_y, count_x, count_y;  // in blocks; corners each way
  float x_m[kMax * kStride], z_m[kMax * kStride];
  std::int32_t found[kMax * kStride];  // 1 or 0
};

// Where the corners' refracted rays intersect the floor's plane, along the body's axes.
__attribute__((noinline)) void find_corners(const View& view, const WaterOptics& optics, float floor_m, int block_px,
                                            Corners& c) {
  const WaterBody& body = optics.body();
  const Vec3<WideF> axis_x = broadcast<WideF>(body.axis_x), axis_z = broadcast<WideF>(body.axis_z),
                    normal = broadcast<WideF>(body.normal), origin = broadcast<WideF>(body.origin);
  const float size = static_cast<float>(block_px);
  for (int j = 0; j < c.count_y; ++j)
    for (int i = 0; i < c.count_x; i += 16) {
      alignas(64) float lane_number[16];
      for (int k = 0; k < 16; ++k) lane_number[k] = static_cast<float>(c.first_x + i + k);
      const Ray<WideF> view_ray =
          pixel_ray(view, WideF::load(lane_number) * WideF(size), WideF(static_cast<float>(c.first_y + j) * size));
      const ExactRay<WideF> at = exact_ray(eye_side(optics), view_ray);
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

struct Options {
  int block = 8;
};
constexpr MethodOption kOptions[] = {
    method_option<&Options::block>("block", 1, 32, "pixels a side of the blocks whose corners are traced"),
};

struct BlockGrid : TrueRays {
  // One analytic plane is intersected: the category's stated exception (docs/methods.md).
  static constexpr MethodCategory kCategory = MethodCategory::kRaster;
  static constexpr bool kMisses = true;  // what is not floor is not shown

  static void prepare(const PrepareIn& in, MethodState& state) {
    auto floors = std::make_unique<Floors>();
    for (const WaterBody& body : in.scene.waters) floors->of_body.push_back(find_floor(in.scene, body));
    state.data = std::move(floors);
  }

  static void narrow(const RasterNarrowIn& in, const NarrowOut& out, std::size_t region) {
    const int block_px = in.state.options_as<Options>().block;
    const Floor& floor = in.state.data_as<Floors>().of_body[static_cast<std::size_t>(in.optics.water.index)];
    const WaterBody& body = in.optics.body();
    Corners corners;
    bool found = false;
    for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
      const std::size_t at_block = block_in_region(block.x_px, block.y_px);
      const InterfaceBlock& interface = in.interface.block[at_block];
      if (interface.shows == 0) return;
      if (!found) {
        const RegionOrigin origin = region_origin(in.grids.frame, region);
        corners.first_x = origin.x_px / block_px, corners.first_y = origin.y_px / block_px;
        corners.count_x = (origin.x_px + kRegionSize - 1) / block_px - corners.first_x + 2;
        corners.count_y = (origin.y_px + kRegionSize - 1) / block_px - corners.first_y + 2;
        find_corners(in.view.view, in.optics, floor.height_m, block_px, corners);
        found = true;
      }
      const FloorPoint p = interpolate(corners, block, block_px);
      const WideI id = floor_ids(floor, p, mask_from_bits(interface.shows & interface.transmitted));
      const Vec3<WideF> position = broadcast<WideF>(body.origin + body.normal * floor.height_m) +
                                   broadcast<WideF>(body.axis_x) * p.x_m + broadcast<WideF>(body.axis_z) * p.z_m;
      HitBlock& hits = out.hits[at_block];
      id.store(hits.refracted_id);
      id.store(hits.refracted_triangle);
      store3(hits.refracted_position, position);
    });
  }

  // From the crossing to the point that was found.
  static PixelRays<WideF> shown_rays(const PixelRaysIn& in) {
    const ExactRay<WideF> at = load_interface(in.interface);
    PixelRays<WideF> r = rays(at, crossing_differential(in, at));
    const Vec3<WideF> way = load3(in.hits.refracted_position) - r.ray.origin_world;
    const WideM aimed = is_triangle(WideI::load(in.hits.refracted_id)) & (dot(way, way) > WideF(1e-12f));
    const Vec3<WideF> direction = normalize(select<WideF>(aimed, way, r.ray.direction_world));
    r.ray.direction_world = select<WideF>(aimed, direction, r.ray.direction_world);
    return r;
  }
};

}  // namespace

Method block_grid() {
  return ray_method<BlockGrid>("block-grid",
                               "rays at block corners, the floor's coordinates interpolated between; for level floors",
                               "Champandard 1999", option_list<Options>(kOptions));
}

}  // namespace shoal::inline SHOAL_ISA_NS
