#include "compare/metrics.h"

#include <cmath>

#include "compare/yee.h"

namespace shoal {

namespace {

PictureMetrics measure_region(const Frame& reference, const Frame& method, const std::vector<float>& flip,
                              const PixelMask& mask) {
  PictureMetrics metrics;
  metrics.flip = mean_of(masked_values(flip, mask));
  metrics.psnr_db = psnr_db(reference.srgb8, method.srgb8, mask);
  return metrics;
}

// The horizontal field of view of a camera's pictures; OpenImageIO's default for a parallel view, which has none.
float horizontal_fov_degrees(const Camera& camera, const Frame& frame) {
  if (camera.orthographic) return 45.0f;
  const double aspect = static_cast<double>(frame.width_px) / static_cast<double>(frame.height_px);
  return static_cast<float>(2 * std::atan(static_cast<double>(camera.tan_half_yfov) * aspect) * 57.29577951308232);
}

}  // namespace

FrameMetrics measure_frame(const RenderScene& scene, const Camera& camera, const Frame& reference, const Frame& method,
                           const MetricSettings& settings, ThreadPool& pool) {
  FrameMetrics metrics;
  metrics.hits = compare_hits(scene, camera, reference, method);
  const LinearPicture a = linear_from_srgb8(reference.width_px, reference.height_px, reference.srgb8.data());
  const LinearPicture b = linear_from_srgb8(method.width_px, method.height_px, method.srgb8.data());
  metrics.flip = ldr_flip(a, b, settings.flip, pool);
  metrics.spots = largest_spots(metrics.flip, reference.width_px, kSpotFlip, kMostSpots);
  metrics.water = measure_region(reference, method, metrics.flip, metrics.hits.water);
  metrics.frame = measure_region(reference, method, metrics.flip, {});
  if (settings.yee) {
    const float fov = horizontal_fov_degrees(camera, reference);
    metrics.water.yee_failed = yee_failed_pixels(a, b, metrics.hits.water, fov, pool.threads());
    metrics.frame.yee_failed = yee_failed_pixels(a, b, {}, fov, pool.threads());
  }
  return metrics;
}

}  // namespace shoal
