// Digests of a frame's targets: XXH3-128 over little-endian rows, top to bottom, of the frame or, for the refracted and
// reflected layers, of their drawn regions. The table of targets (refraction/data/targets.h) names them.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/digest.h"
#include "refraction/data/targets.h"
#include "shading/shadow/shadow_map.h"

namespace shoal {

class StageDigests {
 public:
  // All of them outlive this.
  StageDigests(const Targets& targets, const TargetNeeds& needs, const FrameGrids& grids,
               const LayerRegions& layer_regions);
  ~StageDigests();

  // Adds the planes of one stage as they are now: once, or once for each body of water that shows. Nothing where the
  // targets of that stage do not exist.
  void add(const char* stage);
  void add_shadows(const SunShadows& shadows);
  void add_picture();  // the 8-bit picture

  // Stage and digest, in the order in which stages were first added.
  std::vector<std::pair<std::string, std::string>> list() const;

 private:
  struct Stage;
  void add_blended();
  Digest& digest_of(const char* stage);
  const Targets& targets_;
  const TargetNeeds& needs_;
  const FrameGrids& grids_;
  const LayerRegions& layer_regions_;
  std::vector<std::unique_ptr<Stage>> stages_;
};

}  // namespace shoal
