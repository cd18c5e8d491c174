#include "raster/pass_bins.h"

#include <algorithm>

namespace shoal {

PassBins make_bins(std::size_t meshlet_count) {
  constexpr std::size_t kWorkItems = 128, kMinMeshlets = 4;
  PassBins bins;
  bins.meshlet_count = static_cast<std::uint32_t>(meshlet_count);
  bins.meshlets_per_work_item =
      static_cast<std::uint32_t>(std::max(kMinMeshlets, (meshlet_count + kWorkItems - 1) / kWorkItems));
  bins.work_items.resize((meshlet_count + bins.meshlets_per_work_item - 1) / bins.meshlets_per_work_item);
  return bins;
}

}  // namespace shoal
