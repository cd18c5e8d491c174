// The division of a pass's meshlets into work items.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/bin.h"

namespace shoal {

// Bins of one pass: one work item for each run of meshlets.
struct PassBins {
  std::vector<WorkItemBins> work_items;
  std::uint32_t meshlets_per_work_item = 1;
  std::uint32_t meshlet_count = 0;
};

// Divides meshlets into work items of about equal work, enough of them for any number of threads. Results do not depend
// on the size of a work item.
PassBins make_bins(std::size_t meshlet_count);

}  // namespace shoal
