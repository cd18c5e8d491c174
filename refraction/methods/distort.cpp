// distort: the frame behind the water, pushed across the screen by the waves' normal. Flat water does not refract.
//
// Source  Liu, Han and Fei 2020, Figs. 14 and 15, "the commonly used approach": the scene's colour, sampled at an
//         offset that the normal's tangential part gives. Engines differ in its strength, an option here.
// Differs The offset is in shares of the frame's height, for both axes, so that it keeps its shape in any frame.
#include "refraction/methods/image_space.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

enum Option { kStrength, kReflection, kOptionCount };
constexpr MethodOption kOptions[kOptionCount] = {
    {"strength", "0.1", "offset in frame heights for a normal that lies on its side", MethodOption::Kind::kFloat, -10,
     10},
    {"reflection", "true", "the mirrored picture is pushed too", MethodOption::Kind::kBool, 0, 1},
};

struct Distort : StraightRays {
  static constexpr bool kShadesBefore = true, kWholeScene = true;

  static LayerPlace pushed(const FrameData& f, const Block& block, const ExactRay<WideF>& at) {
    const Vec3<WideF> n = at.plane_normal, tangential = at.normal - n * dot(at.normal, n);
    const Camera& camera = f.view.camera;
    const WideF scale(f.method_option[kStrength] * static_cast<float>(f.grid.height_px));
    const LayerPlace own = own_place(block);
    return {own.x_px + dot(tangential, broadcast<WideF>(camera.right_world)) * scale,
            own.y_px - dot(tangential, broadcast<WideF>(camera.up_world)) * scale};
  }

  static LayerPlace look(const LookUp& l) { return pushed(l.f, l.block, l.at); }

  // What a flat mirror shows at the pushed place: that place's own reflected ray.
  static void mirror(const FrameData& f, const WaterPass& water, const Block& block, WaterRays<WideF>& rays) {
    if (water.surface == nullptr || f.method_option[kReflection] == 0.0f) return;
    const LayerPlace to = pushed(f, block, rays.at_surface);
    const WideF half(0.5f);
    const Ray<WideF> view_ray =
        pixel_ray(f.view, clamp(to.x_px, half, WideF(static_cast<float>(f.grid.width_px)) - half),
                  clamp(to.y_px, half, WideF(static_cast<float>(f.grid.height_px)) - half));
    const ExactRay<WideF> flat = exact_ray(water.optics, view_ray);
    const RayDifferential<WideF> d =
        reflected_differential(at_crossing(view_ray, pixel_ray_differential<WideF>(f.view), flat), flat);
    const Ray<WideF> own = rays.reflected;
    const RayDifferential<WideF> own_d = rays.reflected_differential;
    const WideM on = flat.crosses;
    rays.reflected = {select<WideF>(on, flat.crossing_world, own.origin_world),
                      select<WideF>(on, flat.reflected, own.direction_world)};
    rays.reflected_differential = {
        select<WideF>(on, d.origin_dx, own_d.origin_dx), select<WideF>(on, d.origin_dy, own_d.origin_dy),
        select<WideF>(on, d.direction_dx, own_d.direction_dx), select<WideF>(on, d.direction_dy, own_d.direction_dy)};
  }
};

}  // namespace

Method distort() {
  return {"distort",
          "the frame pushed across the screen by the waves' normal",
          "Liu, Han and Fei 2020, Figs. 14 and 15",
          ShadeBeforeStages<Distort>::kernels(),
          kOptions,
          kOptionCount};
}

}  // namespace shoal::inline SHOAL_ISA_NS
