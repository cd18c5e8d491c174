// How a pass's meshlets are dealt out to threads.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/bin.h"

namespace shoal {

// Bins of one pass: one work_item a run of meshlets.
struct PassBins {
  std::vector<WorkItemBins> work_items;
  std::uint32_t meshlets_per_work_item = 1;
  std::uint32_t meshlet_count = 0;
};
// Items of about equal work, enough of them for any number of threads; results do not depend on their size.
PassBins make_bins(std::size_t meshlet_count);

}  // namespace shoal
