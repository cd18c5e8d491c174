// The kernels of a frame behind function pointers: one table an ISA, and one an ISA and method.
#pragma once

#include <cstddef>
#include <cstdint>

#include "refraction/frame_data.h"

namespace shoal {

class ThreadPool;

// Which of the covered pixels (bit i: lane i of the block at x_px, y_px) a alpha-tested triangle keeps: its material is asked
// where the pass's ray meets it.
using AlphaTest = std::uint32_t (*)(const FrameData&, const WaterPass*, std::int32_t id, int x_px, int y_px,
                                    std::uint32_t cover);

// What is the same for every method.
struct FrameKernels {
  // Item `work_item` of the direct pass: meshlets through vertex, clip, setup into its bins.
  void (*direct_front_end)(FrameData&, std::size_t work_item);
  // The outlines of the water, all in one work_item: they are drawn first.
  void (*water_front_end)(FrameData&);
  // The same meshlets at their virtual positions (WaterPass::map), or mirrored.
  void (*refracted_front_end)(FrameData&, const WaterPass&, std::size_t work_item);
  void (*mirrored_front_end)(FrameData&, const WaterPass&, std::size_t work_item);
  // Bins to visibility, one tile; `early` bins first where there are any; `water` is the pass's, null for the direct
  // one.
  void (*draw_tile)(FrameData&, VisibilityBuffer& out, AlphaTest alpha, const WaterPass* water, const PassBins* early,
                    std::size_t tile);
  AlphaTest direct_alpha, mirrored_alpha;
  // Which pixels of a 64-pixel region show body b: 0 none; bit 0 some, bits 1 to 4 some within 4 px of the left, right,
  // top, bottom side. Their count is added.
  std::uint8_t (*water_in_region)(const FrameData&, std::int32_t body, std::size_t region, std::uint32_t& pixels);
  // The sun's depth: work_item `work_item` of a pass into its bins, and the bins of a map's passes to one tile of depth.
  void (*shadow_front_end)(const ShadowPass&, PassBins&, std::size_t work_item);
  void (*draw_shadow_tile)(const FrameData&, const std::vector<ShadowPass>&, const std::vector<PassBins>&,
                           VisibilityBuffer& out, std::size_t tile);
  // Item `work_item` of the blended meshlets into their bins: direct where `water` is null, else as that pass draws.
  void (*blended_front_end)(FrameData&, const WaterPass* water, std::size_t work_item);
  // Those bins over one region of the direct pass, into Blended::direct.
  void (*blend_direct)(FrameData&, std::size_t region, int thread);
  // Displaced water over one region of the direct pass, where it is in front.
  void (*displaced_water)(FrameData&, std::size_t region);
};

// What a method brings: its broad phase and its narrow phase (refraction/methods/method.h).
struct MethodKernels {
  BroadPhase (*map)(const WaterBody&, const View&);
  AlphaTest refracted_alpha;  // null: the method finds by itself what water shows, and no refracted layer is drawn
  bool follows_waves;         // under waves its rays are looked up in the scene, and no refracted layer is drawn
  void (*narrow)(FrameData&, const WaterPass&, std::size_t region);
  // The blended bins over one region of a water pass, into Blended::refracted or, for a mirrored pass, mirrored.
  void (*blend_water)(FrameData&, const WaterPass&, std::size_t region, int thread);
  // Resolve, light, post: one region of the frame.
  void (*shade)(FrameData&, std::size_t region);
  // Of a method that traces rays instead: one region of the frame, all of it. The stages above are then not used.
  void (*trace)(FrameData&, std::size_t region) = nullptr;
  // Of a method that shades before (refraction/methods/image_space.h), else null: lights the refracted layer, one region.
  void (*light_layer)(FrameData&, const WaterPass&, std::size_t region) = nullptr;
  // Geometry by a map of the method's own, opaque and blended; null: by WaterPass::map.
  void (*refracted_front_end)(FrameData&, const WaterPass&, std::size_t work_item) = nullptr;
  void (*blended_front_end)(FrameData&, const WaterPass&, std::size_t work_item) = nullptr;
  bool whole_scene = false;  // the layer is the whole scene without its water, not the plane's far side alone
  // What the method keeps of the scene's geometry: called once with no camera where nothing moves, else in every frame
  // with that frame's. Throws NotApplicable where the method cannot show the scene.
  void (*prepare)(FrameData&, ThreadPool&, const Camera*) = nullptr;
};

// Which layers a body's passes draw: none for rays that waves bend away from what it would show.
SHOAL_INLINE bool layer_tells(bool follows_waves, const WaterPass& water) {
  return !(follows_waves && water.surface != nullptr);
}
SHOAL_INLINE bool draws_refracted(const MethodKernels& method, const WaterPass& water) {
  return method.refracted_alpha != nullptr && layer_tells(method.follows_waves, water);
}
SHOAL_INLINE bool draws_mirrored(const WaterPass& water) { return water.mirrors && water.surface == nullptr; }

// An option of a method, `--set KEY=VALUE`. Its value is a number: a truth value is 0 or 1.
struct MethodOption {
  enum class Kind : std::uint8_t { kBool, kInt, kFloat };
  const char* key;
  const char* standard;  // the default, as it would be given
  const char* meaning;
  Kind kind;
  float least, most;
};

struct Method {
  const char* name;
  const char* description;
  const char* source;
  MethodKernels kernels;
  const MethodOption* options = nullptr;
  std::size_t option_count = 0;  // at most kMaxMethodOptions
  bool portable = true;          // the same bytes on every machine (docs/DETERMINISM.md)
};

// Throws UsageError for an unknown name.
const Method& find_method(const std::string& name, Isa isa);
const FrameKernels& frame_kernels(Isa isa);

}  // namespace shoal
