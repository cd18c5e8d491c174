// The layer search over a region (refraction/narrow/search_region.h).
#include "refraction/narrow/search_region.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Calls body(block, interface, hits) for each block of the region that shows the body.
template <class Body>
void for_each_water_block(const RasterNarrowIn& in, HitBlock* hits, std::size_t region, Body body) {
  for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    const std::size_t at_block = block_in_region(block.x_px, block.y_px);
    const InterfaceBlock& interface = in.interface.block[at_block];
    if (interface.shows != 0) body(block, interface, hits[at_block]);
  });
}

PixelRaysIn rays_in(const RasterNarrowIn& in, const Block& block, const InterfaceBlock& interface,
                    const HitBlock& hits) {
  return {in.view.view, in.grids.frame, in.optics, block.x_px, block.y_px, interface, hits, in.state.options};
}

// Searches, and adds the lanes' fetches to those of the block.
LayerHits search_block(const RasterNarrowIn& in, const LayerSearch& how, const Block& block, const Ray<WideF>& ray,
                       WideM lanes, HitBlock& hits) {
  WideI fetches = WideI::load(hits.fetches);
  const LayerHits found = search_layer(in.layer, how, block.x_px, block.y_px, ray, lanes, fetches);
  fetches.store(hits.fetches);
  return found;
}

}  // namespace

void search_refracted(const RasterNarrowIn& in, PixelRaysFunction rays, const LayerSearch& how, HitBlock* hits,
                      std::size_t region) {
  for_each_water_block(in, hits, region,
                       [&](const Block& block, const InterfaceBlock& interface, HitBlock& out) SHOAL_LAMBDA {
                         const WideM through = mask_from_bits(interface.shows & interface.transmitted);
                         const PixelRays<WideF> along = refracted_rays(rays, rays_in(in, block, interface, out));
                         const LayerHits found = search_block(in, how, block, along.ray, through, out);
                         found.id.store(out.refracted_id);
                         out.refracted_approximate = static_cast<std::uint16_t>(to_bits(found.approximate));
                       });
}

void search_reflected(const RasterNarrowIn& in, PixelRaysFunction own_rays, const LayerSearch& how, HitBlock* hits,
                      std::size_t region) {
  for_each_water_block(
      in, hits, region, [&](const Block& block, const InterfaceBlock& interface, HitBlock& out) SHOAL_LAMBDA {
        const ExactRay<WideF> at = load_interface(interface);
        const PixelRays<WideF> along = reflected_rays(own_rays, rays_in(in, block, interface, out), at);
        const LayerHits found = search_block(in, how, block, along.ray, mask_from_bits(interface.shows), out);
        found.id.store(out.reflected_id);
        out.reflected_approximate = static_cast<std::uint16_t>(to_bits(found.approximate));
      });
}

}  // namespace shoal::inline SHOAL_ISA_NS
