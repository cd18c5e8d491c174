// Camera and view: from world positions to pixels, and from pixels to rays.
//
// Conventions (docs/ARCHITECTURE.md): metres, right-handed, Y up; pixel (0, 0) is the top left one, its centre at
// (0.5, 0.5) px; depth = near / w for perspective (infinite far), linear for orthographic; greater is nearer.
#pragma once

#include <cstdint>

#include "core/ray.h"
#include "core/vec.h"
#include "core/wide/isa_select.h"

namespace shoal {

struct Camera {
  Vec3f position_world{0, 0, 0};
  Vec3f right_world{1, 0, 0};  // right, up and forward: unit, orthogonal
  Vec3f up_world{0, 1, 0};
  Vec3f forward_world{0, 0, -1};
  bool orthographic = false;
  float tan_half_yfov = 0.57735f;  // perspective
  float xmag_m = 1, ymag_m = 1;    // orthographic: half width and half height of the frame
  float near_m = 0.05f;
  float far_m = 1000.0f;  // orthographic only
};

// The camera of frame k of a repeated run: turned left about world up (+y) by k tenths of a degree, in its place.
Camera turned_left(const Camera& camera, std::int64_t k);

// A camera with a frame size: the constants of all vertices and pixels of a sample (raster/camera.cpp).
struct View {
  Camera camera;
  int width_px = 0, height_px = 0;
  // Screen: x_px = centre_px.x + dot(row_x, p - C) / w, y_px = centre_px.y + dot(row_y, p - C) / w, w = dot(row_w, p -
  // C) (perspective) or 1 (orthographic). row_y points down the screen.
  Vec3f row_x, row_y, row_w;
  Vec2f centre_px;  // includes the sample's offset, so that every stage has one sample a pixel
  // Rays: perspective D = forward + ray_dx * (x - centre.x) + ray_dy * (y - centre.y), O = C; then t is the view depth.
  // Orthographic: O = C + ray_dx * (x - centre.x) + ray_dy * (y - centre.y), D = forward.
  Vec3f ray_dx, ray_dy;
};

// Screen position in clip space: x_px = x / w + centre, depth = z / w.
template <class F>
struct ClipVertex {
  F x, y;  // pixels times w, relative to the frame's centre
  F z, w;  // z = near (perspective), or the depth itself (orthographic, w = 1)
};

//   camera     world
//   width_px, height_px   1 to 16384
//   sample_px  offset of the sample from the pixel's centre, |offset| < 0.5, a multiple of 1/256
View make_view(const Camera& camera, int width_px, int height_px, Vec2f sample_px);

// World position to clip vertex.
template <class F>
SHOAL_INLINE ClipVertex<F> project(const View& view, Vec3<F> position_world) {
  const Vec3<F> p = position_world - broadcast<F>(view.camera.position_world);
  const F x = dot(broadcast<F>(view.row_x), p);
  const F y = dot(broadcast<F>(view.row_y), p);
  const F z_view = dot(broadcast<F>(view.row_w), p);
  if (view.camera.orthographic) {
    const float range = view.camera.far_m - view.camera.near_m;
    return {x, y, (F(view.camera.far_m) - z_view) * F(1.0f / range), F(1.0f)};
  }
  return {x, y, F(view.camera.near_m), z_view};
}

//   x_px, y_px  of the sample: pixel index + 0.5 (the sample's offset is in the view)
template <class F>
SHOAL_INLINE Ray<F> pixel_ray(const View& view, F x_px, F y_px) {
  const F dx = x_px - F(view.centre_px.x), dy = y_px - F(view.centre_px.y);
  const Vec3<F> across = broadcast<F>(view.ray_dx) * dx + broadcast<F>(view.ray_dy) * dy;
  const Vec3<F> eye = broadcast<F>(view.camera.position_world);
  const Vec3<F> forward = broadcast<F>(view.camera.forward_world);
  if (view.camera.orthographic) return {eye + across, forward};
  return {eye, forward + across};
}

// Depth buffer value to metres along the view axis; for a perspective camera 0, where nothing is, gives infinity.
template <class F>
SHOAL_INLINE F view_depth_m(const View& view, F depth) {
  if (view.camera.orthographic) return F(view.camera.far_m) - depth * F(view.camera.far_m - view.camera.near_m);
  return F(view.camera.near_m) / depth;
}

}  // namespace shoal
