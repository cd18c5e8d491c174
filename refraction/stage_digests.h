// Digests of a frame's stage buffers: XXH3-128 over little-endian rows, top to bottom, of the frame or, for the
// refracted and reflected buffers, of the pass's region.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/digest.h"
#include "refraction/frame_data.h"

namespace shoal {

class StageDigests {
 public:
  StageDigests();
  ~StageDigests();
  void shadow(const FrameData& f);  // the sun's maps, where there are any
  void direct(const FrameData& f);
  void refracted(const FrameData& f);  // once a body of water that shows
  void reflected(const FrameData& f);
  void layer(const FrameData& f);    // of a method that shades before
  void blended(const FrameData& f);  // the layers, where the scene has blended materials
  void shaded(const FrameData& f);   // G-buffer and hit buffers
  void picture(const FrameData& f);  // lit and final, once all samples are in

  // Stage and digest, in pipeline order.
  std::vector<std::pair<std::string, std::string>> list() const;

 private:
  struct Stage;
  Digest& stage(const char* name);
  std::vector<std::unique_ptr<Stage>> stages_;
};

}  // namespace shoal
