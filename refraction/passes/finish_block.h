// The end of a block's way: the sample enters the picture, and the last one is encoded.
#pragma once

#include <cstring>

#include "raster/blocks.h"
#include "refraction/data/targets.h"
#include "refraction/data/view_state.h"
#include "shading/block_color.h"
#include "shading/post.h"

namespace shoal::inline SHOAL_ISA_NS {

//   exposure  exposure_scale(post)
//   lit       planes of sums, or empty;  srgb8  RGB rows of the frame
SHOAL_INLINE void finish_block(const ViewState& view, const FrameGrid& frame, const Block& block,
                               const PostSettings& post, float exposure, BlockColor c, LitBuffer& lit,
                               std::uint8_t* srgb8) {
  if (lit.red.size() != 0) {
    float* planes[4] = {lit.red.data() + block.offset, lit.green.data() + block.offset, lit.blue.data() + block.offset,
                        lit.alpha.data() + block.offset};
    WideF* values[4] = {&c.radiance.x, &c.radiance.y, &c.radiance.z, &c.covered};
    for (int i = 0; i < 4; ++i) {
      if (view.sample > 0) *values[i] = WideF::load(planes[i]) + *values[i];
      if (view.last_sample && view.sample_count > 1)
        *values[i] = *values[i] * WideF(1.0f / static_cast<float>(view.sample_count));
      values[i]->store(planes[i]);
    }
  }
  if (!view.last_sample) return;
  const Vec3<WideF> display = tone_map<WideF>(c.radiance, post, exposure);
  const WideI r = encode_srgb8(display.x), g = encode_srgb8(display.y), b = encode_srgb8(display.z);
  const std::size_t row_bytes = static_cast<std::size_t>(frame.width_px) * 3;
  std::uint8_t* pixels =
      srgb8 + static_cast<std::size_t>(block.y_px) * row_bytes + static_cast<std::size_t>(block.x_px) * 3;
  if (all(block.in_frame)) {
    store_rgb8_block(pixels, row_bytes, r, g, b);
    return;
  }
  std::uint8_t tile[48];
  store_rgb8_block(tile, 12, r, g, b);
  const int columns = min(kBlockSize, frame.width_px - block.x_px),
            rows = min(kBlockSize, frame.height_px - block.y_px);
  for (int y = 0; y < rows; ++y)
    std::memcpy(pixels + static_cast<std::size_t>(y) * row_bytes, tile + 12 * y, static_cast<std::size_t>(columns) * 3);
}

}  // namespace shoal::inline SHOAL_ISA_NS
