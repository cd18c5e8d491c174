// Layers of blended fragments: their light and what they let through, laid over whatever is behind.
//
// Source  Porter and Duff 1984 (over, not premultiplied: glTF 2.0, 3.9.4).
// Error   as the sum of its terms: with n layers, 3 n 2^-24 of the largest colour (tests/refraction/test_blend.cpp).
#pragma once

#include <cstdint>

#include "core/blocked_image.h"
#include "core/vec_lanes.h"
#include "raster/blocks.h"

namespace shoal {

// Blended fragments in front of something: colour = light + transmittance * behind, at each sample of a block that has
// any. The planes of the other blocks are not set.
struct BlendLayer {
  AlignedArray<float> red, green, blue;  // linear light of the fragments, dimmed by the nearer ones
  AlignedArray<float> transmittance;     // share of the light behind that passes the fragments: 1 to 0
  AlignedArray<std::uint8_t> filled;     // [blocks] 1: the block's planes are set
  void resize(const FrameGrid& g) {
    for (auto* plane : {&red, &green, &blue, &transmittance}) plane->resize(g.pixel_slots());
    filled.resize(g.block_count());
  }
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// One block of a layer.
struct BlendLanes {
  Vec3<WideF> light{WideF(0.0f), WideF(0.0f), WideF(0.0f)};
  WideF transmittance{1.0f};
};

// Returns the layer's block; an empty one where the block is not filled.
SHOAL_INLINE BlendLanes load_layer(const BlendLayer& layer, const Block& block) {
  if (layer.filled[block.offset / kBlockPixels] == 0) return {};
  return {{WideF::load(layer.red.data() + block.offset), WideF::load(layer.green.data() + block.offset),
           WideF::load(layer.blue.data() + block.offset)},
          WideF::load(layer.transmittance.data() + block.offset)};
}

SHOAL_INLINE void store_layer(BlendLayer& layer, const Block& block, const BlendLanes& v) {
  v.light.x.store(layer.red.data() + block.offset);
  v.light.y.store(layer.green.data() + block.offset);
  v.light.z.store(layer.blue.data() + block.offset);
  v.transmittance.store(layer.transmittance.data() + block.offset);
  layer.filled[block.offset / kBlockPixels] = 1;
}

// Lays a layer over what is behind it.
//   lanes    that have the layer; the others keep their values
//   behind   linear radiance behind the layer; becomes the radiance in front of it
//   covered  the share of each lane that anything covers, updated likewise; null where no one needs it
SHOAL_INLINE void lay_over(const BlendLayer& layer, const Block& block, WideM lanes, Vec3<WideF>& behind,
                           WideF* covered) {
  if (layer.filled[block.offset / kBlockPixels] == 0) return;
  const BlendLanes over = load_layer(layer, block);
  behind = select<WideF>(lanes, over.light + behind * over.transmittance, behind);
  if (covered == nullptr) return;
  const WideF one(1.0f);
  *covered = select(lanes, one - over.transmittance * (one - *covered), *covered);
}

}  // namespace shoal::inline SHOAL_ISA_NS
