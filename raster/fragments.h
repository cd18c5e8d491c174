// Fragments: for each sample of a region the nearest few of all triangles over it, in order, for transparency.
//
// A sample's fragments are ordered nearest first: by greater depth, at equal depth by smaller id. Lists of at most
// kFragmentLayers a sample stay sorted as triangles arrive, so neither their order nor their number matters: what does
// not fit is dropped from the far end, and a further round collects it, which accepts only fragments beyond the last
// one of the round before. Any number of layers is exact in bounded memory (1.1 MB a thread).
//
// Source  Bavoil et al. 2007 (k-buffer); Everitt 2001 (depth peeling), here k layers a round.
// Differs Exact: no fragment is merged or lost when a list is full.
#pragma once

#include <cstdint>

#include "core/blocked_image.h"
#include "core/wide/lanes.h"
#include "raster/visibility.h"

namespace shoal {

inline constexpr int kFragmentLayers = 32;  // a sample, a round
inline constexpr int kRegionBlocks = (kRegionSize / kBlockSize) * (kRegionSize / kBlockSize);

// The n-th nearest fragments of a block's sixteen samples.
struct alignas(64) FragmentLayer {
  float depth[16];      // kNoFragment where a sample has fewer
  std::int32_t id[16];  // kNoId there
};
inline constexpr float kNoFragment = -1.0f;

// The lists of one 64-pixel region; blocks row by row.
struct FragmentLists {
  AlignedArray<FragmentLayer> layers;        // [kRegionBlocks][kFragmentLayers]
  AlignedArray<FragmentLayer> taken;         // [kRegionBlocks] the fragment that each sample's round begins beyond
  std::int32_t count[kRegionBlocks] = {};    // layers that hold anything
  std::uint8_t dropped[kRegionBlocks] = {};  // 1: a list was full
  void allocate() {
    layers.resize(static_cast<std::size_t>(kRegionBlocks) * kFragmentLayers);
    taken.resize(kRegionBlocks);
  }
  FragmentLayer* of_block(int block) { return layers.data() + static_cast<std::size_t>(block) * kFragmentLayers; }
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Whether a fragment is in front of another; no fragment is in front of itself.
SHOAL_INLINE WideM in_front(WideF depth, WideI id, WideF other_depth, WideI other_id) {
  return (depth > other_depth) | ((depth == other_depth) & (id < other_id));
}

// Empties the lists for a round.
//   first  the first round of a region: it accepts every fragment
SHOAL_INLINE void start_round(FragmentLists& lists, bool first) {
  for (int b = 0; b < kRegionBlocks; ++b) {
    lists.count[b] = 0;
    lists.dropped[b] = 0;
    if (!first) continue;
    WideF(3.402823466e38f).store(lists.taken[static_cast<std::size_t>(b)].depth);
    WideI(kNoId).store(lists.taken[static_cast<std::size_t>(b)].id);
  }
}

// Receives the covered blocks of a TileRaster and collects their samples that are in front of the opaque visibility
// buffer.
class FragmentCollector {
 public:
  static constexpr bool kTests = false;
  SHOAL_INLINE FragmentCollector(FragmentLists& lists, const VisibilityBuffer& opaque)
      : lists_(lists), opaque_(opaque) {}

  __attribute__((noinline)) void fragment(std::int32_t triangle, int block_col, int block_row, WideM cover,
                                          WideF at_depth) const {
    const int block = (block_row & 15) * 16 + (block_col & 15);
    const std::size_t at = opaque_.grid.block_offset(block_col, block_row);
    const FragmentLayer& taken = lists_.taken[static_cast<std::size_t>(block)];
    const WideI every(triangle);
    const WideM accepted =
        cover & in_front(at_depth, every, WideF::load(opaque_.depth.data() + at), WideI::load(opaque_.id.data() + at)) &
        in_front(WideF::load(taken.depth), WideI::load(taken.id), at_depth, every);
    if (none(accepted)) return;

    // Insertion, each lane into its own list: a displaced fragment moves on to the next layer.
    WideF depth = select(accepted, at_depth, WideF(kNoFragment));
    WideI id = select(accepted, every, WideI(kNoId));
    FragmentLayer* layers = lists_.of_block(block);
    const int count = lists_.count[block];
    if (count == kFragmentLayers) {
      const FragmentLayer& last = layers[kFragmentLayers - 1];
      if (none(in_front(depth, id, WideF::load(last.depth), WideI::load(last.id)))) {
        lists_.dropped[block] = 1;
        return;
      }
    }
    for (int n = 0; n < count; ++n) {
      const WideF there = WideF::load(layers[n].depth);
      const WideI there_id = WideI::load(layers[n].id);
      const WideM nearer = in_front(depth, id, there, there_id);
      if (none(nearer)) continue;
      select(nearer, depth, there).store(layers[n].depth);
      select(nearer, id, there_id).store(layers[n].id);
      depth = select(nearer, there, depth);
      id = select(nearer, there_id, id);
      if (none(id != WideI(kNoId))) return;
    }
    if (count == kFragmentLayers) {
      lists_.dropped[block] = 1;
      return;
    }
    depth.store(layers[count].depth);
    id.store(layers[count].id);
    lists_.count[block] = count + 1;
  }

 private:
  FragmentLists& lists_;
  const VisibilityBuffer& opaque_;
};

// Prepares a block for a further round, in which each sample begins beyond its last fragment if any was dropped there.
//   more  samples that need further fragments
// Returns false where the block needs no further round.
SHOAL_INLINE bool continue_block(FragmentLists& lists, int block, WideM more) {
  FragmentLayer& taken = lists.taken[static_cast<std::size_t>(block)];
  const FragmentLayer& last = lists.of_block(block)[kFragmentLayers - 1];
  WideF depth(kNoFragment);
  WideI id(kNoId);
  bool goes_on = false;
  if (lists.dropped[block] != 0) {
    depth = select(more, WideF::load(last.depth), depth);
    id = select(more, WideI::load(last.id), id);
    goes_on = any(id != WideI(kNoId));
  }
  depth.store(taken.depth);
  id.store(taken.id);
  return goes_on;
}

}  // namespace shoal::inline SHOAL_ISA_NS
