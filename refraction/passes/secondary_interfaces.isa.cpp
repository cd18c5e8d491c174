// Rays that cross a secondary water interface (refraction/passes/shade_water.h).
#include "refraction/data/capture.h"
#include "refraction/passes/shade_water.h"
#include "trace/nearest_hit.h"
#include "trace/path_tracer.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// First hits by the BVH; blended materials on the way are not composited.
struct BvhRays {
  const SecondaryIn& in;
  NearestHit first_hits(const Path& path, WideF t_far) const {
    return nearest_hits(*in.trace.bvh, in.scene.shading, path.ray, path.differential, {WideI(kNoId), t_far},
                        path.lanes);
  }
  static void count(RayCounts::Kind, WideM) {}
  static const Bvh16* blended() { return nullptr; }
};

// Hits that the pixel shows, into the captured hit buffers. Paths start behind the eye's own crossing here.
struct HitRecorder {
  const SecondaryIn& in;
  HitPoints& hits;
  std::size_t offset;

  static void visible(const Path&, WideI, const WaterCrossing&, WideM, WideM) {}
  static void surface(const SurfaceSample<WideF>&, WideM) {}
  static void water(const ExactRay<WideF>&, WideM) {}
  void secondary(WideM lanes) {
    if (in.view.capture) store_plane(hits.secondary, offset, WideI(1), lanes);
  }
  void shown(const Path& path, const Vec3<WideF>& position, WideI id, WideM lanes) {
    if (!in.view.capture) return;
    const Vec3<WideF> image =
        path.shown_as == HitKind::kSurface ? virtual_position(in.optics.exact, position) : position;
    store_hits(hits, offset, path.shown_as, id, position, image, lanes);
  }
};

}  // namespace

void trace_secondary_interfaces(const SecondaryIn& in, const SecondaryOut& out, std::size_t region) {
  for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    const std::size_t at_block = block_in_region(block.x_px, block.y_px);
    const InterfaceBlock& interface = in.interface.block[at_block];
    SecondaryBlock& light = out.light[at_block];
    light.lanes = 0;
    if (interface.shows == 0) return;
    const HitBlock& hits = in.hits[at_block];
    const WideM here = mask_from_bits(interface.shows), transmitted = mask_from_bits(interface.transmitted);
    const WideM refracted =
        in.refracted ? here & transmitted & (WideI::load(hits.refracted_id) < WideI(0)) : mask_from_bits(0);
    const WideM reflected =
        in.optics.reflects_scene() ? here & (WideI::load(hits.reflected_id) < WideI(0)) : mask_from_bits(0);
    if (none(refracted | reflected)) return;

    const ExactRay<WideF> at = load_interface(interface);
    const PixelRaysIn rays_in{in.view.view, in.grids.frame, in.optics, block.x_px,
                              block.y_px,   interface,      hits,      in.options};
    const BvhRays rays{in};
    HitRecorder recorder{in, out.hits, block.offset};
    TraceLimits limits;
    limits.reflects_scene = in.reflects_scene;
    const auto trace = [&](bool reflected_rays_go, const PixelRays<WideF>& from, WideM lanes) {
      Path path;
      static_cast<WaterQuery&>(path) = onward_query(in.optics, at, from.ray, reflected_rays_go, lanes);
      path.differential = from.differential;
      path.weight =
          broadcast<WideF>(Vec3f{1, 1, 1}) * (reflected_rays_go ? at.reflectance : WideF(1.0f) - at.reflectance);
      path.level = 2;
      path.medium = reflected_rays_go ? in.view.eye_in_water : in.optics.exact.eye_below ? kAir : in.optics.water.index;
      path.shows = reflected_rays_go ? lanes & !transmitted : lanes;
      path.shown_as = reflected_rays_go ? HitKind::kMirror : HitKind::kSurface;
      path.first_body = in.optics.water.index;
      BlockColor brought;
      PathTracer(in.scene, rays, recorder, in.optics.pixel, limits, brought).trace(path);
      return brought.radiance;
    };
    Vec3<WideF> sum = broadcast<WideF>(Vec3f{0, 0, 0});
    if (any(refracted)) sum = trace(false, refracted_rays(in.rays, rays_in), refracted);
    if (any(reflected)) sum = sum + trace(true, reflected_rays(in.own_reflected, rays_in, at), reflected);
    light.lanes = static_cast<std::uint16_t>(to_bits(refracted | reflected));
    store3(light.radiance, sum);
  });
}

}  // namespace shoal::inline SHOAL_ISA_NS
