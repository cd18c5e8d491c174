#include "compare/yee.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "core/error.h"

namespace shoal {

std::uint64_t yee_failed_pixels(const LinearPicture& a, const LinearPicture& b, const PixelMask& mask,
                                float fov_degrees, int threads) {
  std::vector<float> first = a.rgb, second = b.rgb;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    for (std::size_t c = 3 * i; !mask[i] && c < 3 * i + 3; ++c) second[c] = first[c];
  }
  const OIIO::ImageSpec spec(a.width_px, a.height_px, 3, OIIO::TypeDesc::FLOAT);
  const OIIO::ImageBuf image_a(spec, first.data()), image_b(spec, second.data());
  OIIO::ImageBufAlgo::CompareResults result{};
  OIIO::ImageBufAlgo::compare_Yee(image_a, image_b, result, 100.0f, fov_degrees, {}, threads);
  if (result.error || image_a.has_error() || image_b.has_error()) {
    throw Error("Yee's metric: OpenImageIO could not compare the pictures; expected two of the same size");
  }
  return static_cast<std::uint64_t>(result.nfail);
}

}  // namespace shoal
