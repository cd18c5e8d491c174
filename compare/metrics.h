// All metrics of one method's frame against the reference's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/flip.h"
#include "compare/hits.h"
#include "compare/spots.h"

namespace shoal {

// Over the water's pixels, or over the frame.
struct PictureMetrics {
  double flip = 0;     // mean LDR-FLIP of the 8-bit pictures; NaN of no pixels
  double psnr_db = 0;  // infinite of equal pictures, NaN of no pixels
  std::optional<std::uint64_t> yee_failed;
};

struct FrameMetrics {
  PictureMetrics water, frame;
  HitComparison hits;
  std::vector<float> flip;  // of each pixel
  std::vector<Spot> spots;  // of the FLIP map, the largest first
};

struct MetricSettings {
  FlipSettings flip;
  bool yee = false;
};

// Measures a frame against the reference.
//
//   scene, camera      as the frames were drawn: compare_hits
//   reference, method  pictures and kHitAovs, of the same size
FrameMetrics measure_frame(const RenderScene& scene, const Camera& camera, const Frame& reference, const Frame& method,
                           const MetricSettings& settings, ThreadPool& pool);

}  // namespace shoal
