// Any bytes as a picture: PNG, JPEG, Radiance HDR or OpenEXR, as the loader of scenes reads it.
#include <cmath>

#include "core/error.h"
#include "scene/images/images.h"
#include "tests/fuzz/fuzz_input.h"

namespace shoal::test {
namespace {

constexpr ImageLimits kLimits{512, 1 << 16};

void check_texture(const Texture& texture, const ImageSize& size) {
  promise(texture.width[0] == size.width && texture.height[0] == size.height, "the header's size is not the picture's");
  promise((texture.format == TexelFormat::kRgba32Float) == size.is_float, "the header's format is not the picture's");
  promise(texture.width[texture.level_count - 1] == 1 && texture.height[texture.level_count - 1] == 1,
          "the last level is not one texel");
  for (const float value : texture.rgba32f) promise(std::fabs(value) <= 1e9f, "a texel is not finite");
}

}  // namespace

std::string outcome_of(std::span<const std::uint8_t> bytes) {
  try {
    const ImageSize size = image_size(bytes, "picture", kLimits);
    promise(size.width <= kLimits.max_size && size.height <= kLimits.max_size, "a limit does not hold");
    check_texture(decode_texture(bytes, "picture", true, kLimits), size);
  } catch (const Error& error) {
    const std::string message = error.what();
    promise(is_one_line(message) && message.rfind("picture: ", 0) == 0, "an error is not one line about the picture");
    return message;
  }
  return "loaded";
}

}  // namespace shoal::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  shoal::test::outcome_of({data, size});
  return 0;
}
