#include "raster/camera.h"

#include "core/math.h"

namespace shoal {

Camera turned_left(const Camera& camera, std::int64_t k) {
  if (k == 0) return camera;
  constexpr float kTenthDegree = 0.00174532925f;
  const float angle = static_cast<float>(k % 3600) * kTenthDegree;
  const float s = det_sin(angle), c = det_cos(angle);
  const auto turn = [&](Vec3f v) { return Vec3f{c * v.x + s * v.z, v.y, c * v.z - s * v.x}; };
  Camera turned = camera;
  turned.right_world = turn(camera.right_world);
  turned.up_world = turn(camera.up_world);
  turned.forward_world = turn(camera.forward_world);
  return turned;
}

View make_view(const Camera& camera, int width_px, int height_px, Vec2f sample_px) {
  View v;
  v.camera = camera;
  v.width_px = width_px;
  v.height_px = height_px;
  const float w = static_cast<float>(width_px), h = static_cast<float>(height_px);
  // Moving the sample by +s moves the picture by -s.
  v.centre_px = {w * 0.5f - sample_px.x, h * 0.5f - sample_px.y};
  float px_per_x, px_per_y;  // pixels a unit of x / w
  if (camera.orthographic) {
    px_per_x = w * 0.5f / camera.xmag_m;
    px_per_y = h * 0.5f / camera.ymag_m;
  } else {
    px_per_y = h * 0.5f / camera.tan_half_yfov;
    px_per_x = px_per_y;  // square pixels: the aspect comes from the frame
  }
  v.row_x = camera.right_world * px_per_x;
  v.row_y = camera.up_world * -px_per_y;
  v.row_w = camera.forward_world;
  v.ray_dx = camera.right_world * (1.0f / px_per_x);
  v.ray_dy = camera.up_world * (-1.0f / px_per_y);
  return v;
}

}  // namespace shoal
