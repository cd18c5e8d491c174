// One world point through the broad phase, for `shoal probe`.
#include "core/float_mode.h"
#include "refraction/broad/broad_phase.h"
#include "refraction/renderer.h"

namespace shoal {

PointProbe probe_point(const RenderScene& scene, const Camera& camera, int width_px, int height_px, Vec3f world) {
  const FloatModeGuard mode;
  const View view = make_view(camera, width_px, height_px, {0, 0});
  PointProbe out;
  out.world = out.virtual_world = out.crossing_world = world;
  out.path_m = length(world - camera.position_world);
  if (!scene.waters.empty()) {
    const BroadPhase bp = make_broad_phase(scene.waters.front(), view);
    out.side = dot(world - bp.plane_origin, bp.normal) < 0.0f ? "water" : "air";
    const PointPath<float> path = point_path(bp, world);
    out.refracted = far_distance(bp, world) > 0.0f;
    out.virtual_world = path.virtual_world;
    out.crossing_world = path.crossing_world;
    out.path_m = path.eye_side_m + path.far_side_m;
  }
  const ClipVertex<float> clip = project(view, out.virtual_world);
  out.pixel = {clip.x / clip.w + view.centre_px.x, clip.y / clip.w + view.centre_px.y};
  if (!(clip.w > 0.0f)) out.pixel = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN()};
  return out;
}

}  // namespace shoal
