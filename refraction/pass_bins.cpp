#include "refraction/pass_bins.h"

#include <algorithm>

namespace shoal {

PassBins make_bins(std::size_t chunk_count) {
  constexpr std::size_t kItems = 128, kLeastChunks = 4;
  PassBins bins;
  bins.chunk_count = static_cast<std::uint32_t>(chunk_count);
  bins.chunks_per_item = static_cast<std::uint32_t>(std::max(kLeastChunks, (chunk_count + kItems - 1) / kItems));
  bins.items.resize((chunk_count + bins.chunks_per_item - 1) / bins.chunks_per_item);
  return bins;
}

}  // namespace shoal
