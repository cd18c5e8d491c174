// How much consecutive frames of two animations differ (scripts/animation).
//
//   frame_changes <LIST >CSV
//
// A line of LIST is a frame: OURS <tab> REFERENCE, two 8-bit pictures, all of one size. A row of CSV is a step from the
// frame before: frame, mean absolute difference of ours and of the reference (code values, over R, G and B), their
// ratio, and the block of 16 x 16 pixels whose change exceeds the reference's most: x, y, its mean difference in ours
// and in the reference.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "scene/images/images.h"
#include "shading/textures/texture.h"

namespace {

using shoal::Texture;

constexpr int kBlock = 16;

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

Picture load(const std::string& path) {
  const Texture texture = shoal::load_texture(path, true);
  return {texture.width[0], texture.height[0], shoal::texture_bytes(texture)};
}

// Sums of absolute differences, one a block, row by row.
std::vector<std::uint64_t> block_sums(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height) throw shoal::Error("frames differ in size; expected one size");
  const int columns = (a.width + kBlock - 1) / kBlock, rows = (a.height + kBlock - 1) / kBlock;
  std::vector<std::uint64_t> sums(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const std::size_t at =
          4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x));
      std::uint64_t& sum = sums[static_cast<std::size_t>(y / kBlock * columns + x / kBlock)];
      for (std::size_t c = 0; c < 3; ++c) sum += static_cast<std::uint64_t>(std::abs(a.rgba[at + c] - b.rgba[at + c]));
    }
  }
  return sums;
}

double total(const std::vector<std::uint64_t>& sums) {
  std::uint64_t sum = 0;
  for (const std::uint64_t s : sums) sum += s;
  return static_cast<double>(sum);
}

void report(int frame, const Picture& size, const std::vector<std::uint64_t>& ours,
            const std::vector<std::uint64_t>& truth) {
  if (ours.size() != truth.size()) throw shoal::Error("the animations differ in size; expected one size");
  std::size_t worst = 0;
  const auto excess = [&](std::size_t i) { return static_cast<double>(ours[i]) - static_cast<double>(truth[i]); };
  for (std::size_t i = 1; i < ours.size(); ++i)
    if (excess(i) > excess(worst)) worst = i;
  const int columns = (size.width + kBlock - 1) / kBlock;
  const int x = static_cast<int>(worst) % columns * kBlock, y = static_cast<int>(worst) / columns * kBlock;
  const double samples = 3.0 * size.width * size.height;
  const double in_block = 3.0 * std::min(kBlock, size.width - x) * std::min(kBlock, size.height - y);
  const double all_ours = total(ours), all_truth = total(truth);
  std::printf("%d,%.5f,%.5f,%.4f,%d,%d,%.3f,%.3f\n", frame, all_ours / samples, all_truth / samples,
              all_truth > 0 ? all_ours / all_truth : 0.0, x, y, static_cast<double>(ours[worst]) / in_block,
              static_cast<double>(truth[worst]) / in_block);
}

}  // namespace

int main() {
  try {
    std::printf("frame,ours,truth,ratio,block_x,block_y,block_ours,block_truth\n");
    Picture before[2];
    int frame = 0;
    for (std::string line; std::getline(std::cin, line); ++frame) {
      const std::size_t tab = line.find('\t');
      if (tab == std::string::npos)
        throw shoal::Error("standard input: no tab in '" + line + "'; expected OURS <tab> REFERENCE");
      Picture now[2] = {load(line.substr(0, tab)), load(line.substr(tab + 1))};
      if (frame > 0) report(frame, now[0], block_sums(before[0], now[0]), block_sums(before[1], now[1]));
      for (int i = 0; i < 2; ++i) before[i] = std::move(now[i]);
    }
    if (frame < 2) throw shoal::Error("standard input: fewer than two frames; expected a line for each");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "frame_changes: error: %s\n", error.what());
    return 1;
  }
}
