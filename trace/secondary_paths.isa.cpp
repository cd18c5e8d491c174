// Rays that meet water again (trace/path.h).
#include "trace/path_tracer.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct RasterScene {
  static constexpr bool kBlends = false;
  static WideI first_hits(const FrameData& f, const Path& path, WideF t_far) {
    return nearest_hits(f, path.ray, path.differential, {WideI(kNoId), t_far}, path.lanes).id;
  }
  static void count(const FrameData&, RayCounts::Kind, WideM) {}
};

}  // namespace

Vec3<WideF> follow_again(FrameData& f, const Block& block, const Path& path) {
  BlockColor brought;
  Tracer<RasterScene>(f, block, TraceLimits(), brought).follow(path);
  return brought.radiance;
}

}  // namespace shoal::inline SHOAL_ISA_NS
