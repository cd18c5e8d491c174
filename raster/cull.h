// Conservative culling of whole meshlets against the part of the frame that a pass draws.
#pragma once

#include "core/vec.h"
#include "core/wide/lanes.h"
#include "raster/camera.h"
#include "raster/setup.h"

namespace shoal {

// Four side planes and the near plane of the part of the frame that a pass draws: inside is >= 0.
struct Frustum {
  Vec3f normal[5];
  float offset[5];
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Widened by two pixels, far more than rounding can move a vertex.
inline Frustum make_frustum(const View& view, int x_min, int y_min, int x_max, int y_max) {
  const float left = static_cast<float>(x_min) - 2.0f - view.centre_px.x;
  const float right = static_cast<float>(x_max) + 3.0f - view.centre_px.x;
  const float top = static_cast<float>(y_min) - 2.0f - view.centre_px.y;
  const float bottom = static_cast<float>(y_max) + 3.0f - view.centre_px.y;
  Frustum f;
  const bool ortho = view.camera.orthographic;
  // x / w >= left is x - left w >= 0; an orthographic w is 1.
  auto side = [&](int i, Vec3f row, float sign, float edge) {
    f.normal[i] = ortho ? row * sign : (row - view.row_w * edge) * sign;
    f.offset[i] = (ortho ? -edge * sign : 0.0f) - dot(f.normal[i], view.camera.position_world);
  };
  side(0, view.row_x, 1.0f, left);
  side(1, view.row_x, -1.0f, right);
  side(2, view.row_y, 1.0f, top);
  side(3, view.row_y, -1.0f, bottom);
  f.normal[4] = view.row_w;
  f.offset[4] = -dot(view.row_w, view.camera.position_world) - view.camera.near_m * 0.99f;
  return f;
}

// Whether no point of the box is inside; in doubt false.
inline bool box_outside(const Frustum& f, Vec3f lo, Vec3f hi) {
  for (int i = 0; i < 5; ++i) {
    const Vec3f n = f.normal[i];
    const Vec3f far_corner{n.x > 0 ? hi.x : lo.x, n.y > 0 ? hi.y : lo.y, n.z > 0 ? hi.z : lo.z};
    const float size = abs(n.x * far_corner.x) + abs(n.y * far_corner.y) + abs(n.z * far_corner.z) + abs(f.offset[i]);
    if (dot(n, far_corner) + f.offset[i] < size * -1e-5f) return true;
  }
  return false;
}

}  // namespace shoal::inline SHOAL_ISA_NS
