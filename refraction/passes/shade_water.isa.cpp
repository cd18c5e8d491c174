// The light of water pixels (refraction/passes/shade_water.h).
#include "refraction/passes/shade_water.h"

#include "refraction/data/capture.h"
#include "refraction/passes/prefetch.h"
#include "scene/water_absorption.h"
#include "shading/shade_hits.h"
#include "shading/sky.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// One block of a body's water pixels.
struct WaterBlock {
  const ShadeWaterIn& in;
  const ShadeWaterOut& out;
  const Block& block;
  const InterfaceBlock& interface;
  const HitBlock& hits;
  PixelRaysIn rays_in;

  // Radiance along rays into (or, for an eye in the water, back down from) the surface.
  //   shown  the triangle that each ray hits, kNoId none;  lanes  that are wanted
  //   image_of(position): where a hit is recorded to appear;  recorded: the lanes whose hits the pixel shows
  template <class ImageOf>
  Vec3<WideF> radiance_along(const PixelRays<WideF>& rays, WideI shown, WideM lanes, bool in_water, HitKind kind,
                             WideM recorded, ImageOf image_of) const {
    const WaterBody& body = in.optics.body();
    const WideM hit = lanes & is_triangle(shown);
    Vec3<WideF> radiance = broadcast<WideF>(Vec3f{0, 0, 0});
    WideF path_m(kFarAway_m);
    if (any(lanes & !hit)) {
      radiance = background_radiance<WideF>(in.scene.background(), rays.ray.direction_world);
      // The ray leaves the scene through the water's bottom.
      const WideF descent = abs(dot(rays.ray.direction_world, broadcast<WideF>(body.normal)));
      path_m = WideF(body.depth_m) / max(descent, WideF(1e-3f));
    }
    if (any(hit)) {
      ShadedLanes s;
      shade_hits(in.scene.shading, rays.ray, rays.differential, shown, hit,
                 in_water ? &in.scene.light_media[in.optics.water.index] : nullptr, s);
      radiance = select<WideF>(hit, s.radiance, radiance);
      path_m = select(hit, max(s.t, WideF(0.0f)), path_m);
      if (in.view.capture) {
        const Vec3<WideF> p = s.surface.position_world;
        store_hits(out.hits, block.offset, kind, shown, p, image_of(p), hit & recorded);
      }
    }
    if (in_water) radiance = radiance * absorbed(body, path_m);
    return radiance;
  }

  // What an image-space method fetched from its lit layer.
  Vec3<WideF> fetched_radiance(const FetchedBlock& fetched, WideM through) const {
    if (in.view.capture) {
      const WideI shown = WideI::load(hits.refracted_id);
      const Vec3<WideF> p = load3(fetched.position_world);
      store_hits(out.hits, block.offset, HitKind::kSurface, shown, p, virtual_position(in.optics.exact, p),
                 through & is_triangle(shown));
      store_plane(out.hits.approximate, block.offset, WideI::load(fetched.approximate), through);
    }
    return select<WideF>(through, load3(fetched.radiance), broadcast<WideF>(Vec3f{0, 0, 0}));
  }

  // Turns rays towards points.
  static void aim(Ray<WideF>& ray, const Vec3<WideF>& point, WideM lanes) {
    const Vec3<WideF> way = point - ray.origin_world;
    const WideM turned = lanes & (dot(way, way) > WideF(1e-12f));
    const Vec3<WideF> direction = normalize(select<WideF>(turned, way, ray.direction_world));
    ray.direction_world = select<WideF>(turned, direction, ray.direction_world);
  }

  // The captured pixels that show a candidate which their ray does not hit.
  void mark_approximate(int lanes) const {
    if (!in.view.capture || lanes == 0) return;
    store_plane(out.hits.approximate, block.offset, WideI(1), mask_from_bits(static_cast<std::uint32_t>(lanes)));
  }

  // Radiance along the refracted rays, 0 where they cross a secondary interface.
  Vec3<WideF> refracted(const ExactRay<WideF>& at, WideM through) const {
    const WideI shown = WideI::load(hits.refracted_id);
    const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
    if (in.misses && in.view.capture)
      store_hits(out.hits, block.offset, HitKind::kMiss, WideI(kNoId), zero, zero, through & !is_triangle(shown));
    const WideM secondary = through & (shown < WideI(0));
    const PixelRays<WideF> rays = refracted_rays(in.rays, rays_in);
    mark_approximate(hits.refracted_approximate & interface.transmitted);
    const Vec3<WideF> radiance =
        radiance_along(rays, shown, through & !secondary, !in.optics.exact.eye_below, HitKind::kSurface, at.transmitted,
                       [&](const Vec3<WideF>& p) SHOAL_LAMBDA { return virtual_position(in.optics.exact, p); });
    return select<WideF>(secondary, zero, radiance);
  }

  // Radiance along the reflected rays, 0 where they cross a secondary interface. Filtered waves reflect the background
  // that the interface stage averaged over the slopes that the pixel hides, where the method reflects the surface's
  // own rays.
  Vec3<WideF> reflected(const ExactRay<WideF>& at, WideM lanes) const {
    const bool eye_below = in.optics.exact.eye_below;
    const bool filtered = filtering_pixel(in.optics) != nullptr && in.own_reflected == nullptr;
    const auto filtered_background = [&]() SHOAL_LAMBDA {
      return interface_detail::get3(interface, InterfaceBlock::kBackground);
    };
    if (!in.optics.reflects_scene()) {
      if (filtered) return filtered_background();
      const PixelRays<WideF> rays = reflected_rays(in.own_reflected, rays_in, at);
      return background_radiance<WideF>(in.scene.background(), rays.ray.direction_world);
    }
    const WideI shown = WideI::load(hits.reflected_id);
    const WideM secondary = lanes & (shown < WideI(0));
    PixelRays<WideF> rays = reflected_rays(in.own_reflected, rays_in, at);
    if (hits.reflected_aimed != 0) aim(rays.ray, load3(hits.reflected_position), mask_from_bits(hits.reflected_aimed));
    mark_approximate(hits.reflected_approximate & ~interface.transmitted);
    Vec3<WideF> radiance = radiance_along(rays, shown, lanes & !secondary, eye_below, HitKind::kMirror, !at.transmitted,
                                          [](const Vec3<WideF>& p) SHOAL_LAMBDA { return p; });
    if (filtered && !eye_below) radiance = select<WideF>(lanes & !is_triangle(shown), filtered_background(), radiance);
    return select<WideF>(secondary, broadcast<WideF>(Vec3f{0, 0, 0}), radiance);
  }

  // Everything that the block's water pixels show, absorbed on the way to an eye in the water.
  __attribute__((noinline)) void shade() const {
    const WideM lanes = mask_from_bits(interface.shows);
    const ExactRay<WideF> at = load_interface(interface);
    const WideM through = lanes & at.transmitted;
    const std::size_t at_block = block_in_region(block.x_px, block.y_px);
    Vec3<WideF> below = broadcast<WideF>(Vec3f{0, 0, 0});
    if (any(through))
      below = in.fetched != nullptr ? fetched_radiance(in.fetched[at_block], through) : refracted(at, through);
    Vec3<WideF> above = reflected(at, lanes);
    if (in.blended_refracted != nullptr) {
      lay_over(*in.blended_refracted, block, through, below, nullptr);
      if (in.optics.reflects_scene()) lay_over(*in.blended_reflected, block, lanes, above, nullptr);
    }
    const SecondaryBlock& secondary = in.secondary[at_block];
    const Vec3<WideF> from_water = secondary.lanes != 0 ? load3(secondary.radiance) : broadcast<WideF>(Vec3f{0, 0, 0});
    Vec3<WideF> mixed = (below * (WideF(1.0f) - at.reflectance) + above * at.reflectance) + from_water;
    if (in.view.eye_in_water >= 0) {
      const WaterBody& around_eye = *in.scene.water[static_cast<std::size_t>(in.view.eye_in_water)].body;
      const WideF eye_path_m = length(at.crossing_world - block_rays(in.view.view, block).origin_world);
      mixed = mixed * absorbed(around_eye, max(eye_path_m, WideF(0.0f)));
    }
    store_plane(out.light.radiance, block.offset, mixed, lanes);
  }
};

}  // namespace

void shade_water(const ShadeWaterIn& in, const ShadeWaterOut& out, std::size_t region) {
  for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    const std::size_t at_block = block_in_region(block.x_px, block.y_px);
    const InterfaceBlock& interface = in.interface.block[at_block];
    prefetch_block_triangles(in.scene, in.hits, at_block);
    if (interface.shows == 0) return;
    const HitBlock& hits = in.hits[at_block];
    WaterBlock{in,    out,
               block, interface,
               hits,  {in.view.view, in.grids.frame, in.optics, block.x_px, block.y_px, interface, hits, in.options}}
        .shade();
  });
}

}  // namespace shoal::inline SHOAL_ISA_NS
