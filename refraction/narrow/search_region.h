// The layer search over the water pixels of a region (refraction/narrow/search_layer.h).
#pragma once

#include "refraction/data/category.h"
#include "refraction/narrow/search_layer.h"

namespace shoal::inline SHOAL_ISA_NS {

// HitBlock::refracted_id of a region's water pixels, by the refracted layers.
//   rays  of the method
void search_refracted(const RasterNarrowIn& in, PixelRaysFunction rays, const LayerSearch& how, HitBlock* hits,
                      std::size_t region);

// HitBlock::reflected_id, by the planar reflection layers.
//   own_rays  a method's own reflected rays, or null: those of the surface
void search_reflected(const RasterNarrowIn& in, PixelRaysFunction own_rays, const LayerSearch& how, HitBlock* hits,
                      std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
