// How a pass's chunks are dealt out to threads.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/bin.h"

namespace shoal {

// Bins of one pass: one item a run of chunks.
struct PassBins {
  std::vector<BinItem> items;
  std::uint32_t chunks_per_item = 1;
  std::uint32_t chunk_count = 0;
};
// Items of about equal work, enough of them for any number of threads; results do not depend on their size.
PassBins make_bins(std::size_t chunk_count);

}  // namespace shoal
