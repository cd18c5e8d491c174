// distort: the frame behind the water, pushed across the screen by the waves' normal. Flat water does not refract.
//
// Source  Liu, Han and Fei 2020, Figs. 14 and 15, "the commonly used approach": the scene's colour, sampled at an
//         offset that the normal's tangential part gives. Engines differ in its strength, an option here.
// Differs The offset is in shares of the frame's height, for both axes, so that it keeps its shape in any frame.
#include "refraction/methods/image_space.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct Options {
  float strength = 0.1f;
  bool reflection = true;
};
constexpr MethodOption kOptions[] = {
    method_option<&Options::strength>("strength", -10, 10,
                                      "offset in frame heights for a normal that lies on its side"),
    method_option<&Options::reflection>("reflection", "the reflected picture is pushed too"),
};

struct Distort : StraightRays {
  static constexpr bool kWholeScene = true;

  static LayerPlace<WideF> pushed(const View& view, const FrameGrid& frame, int x_px, int y_px,
                                  const ExactRay<WideF>& at, float strength) {
    const Vec3<WideF> n = at.plane_normal, tangential = at.normal - n * dot(at.normal, n);
    const Camera& camera = view.camera;
    const WideF scale(strength * static_cast<float>(frame.height_px));
    const LayerPlace<WideF> own = own_place(x_px, y_px);
    return {own.x_px + dot(tangential, broadcast<WideF>(camera.right_world)) * scale,
            own.y_px - dot(tangential, broadcast<WideF>(camera.up_world)) * scale};
  }

  static LayerPlace<WideF> sample_place(const SampleIn& in) {
    return pushed(in.view(), in.narrow.grids.frame, in.block.x_px, in.block.y_px, in.at,
                  in.options<Options>().strength);
  }

  static LayerPlace<WideF> planar_place(const SampleIn& in) {
    const Options& options = in.options<Options>();
    return pushed(in.view(), in.narrow.grids.frame, in.block.x_px, in.block.y_px, in.at,
                  options.reflection ? options.strength : 0.0f);
  }

  // What a flat mirror shows at the pushed place: that place's own reflected ray.
  static PixelRays<WideF> reflected_rays(const PixelRaysIn& in) {
    const Options& options = *static_cast<const Options*>(in.options);
    const ExactRay<WideF> at = load_interface(in.interface);
    const PixelRays<WideF> own = shoal::reflected_rays(in, at);
    if (in.optics.surface() == nullptr || !options.reflection) return own;
    const LayerPlace<WideF> to = pushed(in.view, in.frame, in.x_px, in.y_px, at, options.strength);
    const WideF half(0.5f);
    const Ray<WideF> view_ray =
        pixel_ray(in.view, clamp(to.x_px, half, WideF(static_cast<float>(in.frame.width_px)) - half),
                  clamp(to.y_px, half, WideF(static_cast<float>(in.frame.height_px)) - half));
    const ExactRay<WideF> flat = exact_ray(in.optics.exact, view_ray);
    const RayDifferential<WideF> d =
        reflected_differential(at_crossing(view_ray, pixel_ray_differential<WideF>(in.view), flat), flat);
    const WideM on = flat.crosses;
    return {{select<WideF>(on, flat.crossing_world, own.ray.origin_world),
             select<WideF>(on, flat.reflected, own.ray.direction_world)},
            {select<WideF>(on, d.origin_dx, own.differential.origin_dx),
             select<WideF>(on, d.origin_dy, own.differential.origin_dy),
             select<WideF>(on, d.direction_dx, own.differential.direction_dx),
             select<WideF>(on, d.direction_dy, own.differential.direction_dy)}};
  }
};

}  // namespace

Method distort() {
  return image_space_method<Distort>("distort", "the frame pushed across the screen by the waves' normal",
                                     "Liu, Han and Fei 2020, Figs. 14 and 15", option_list<Options>(kOptions));
}

}  // namespace shoal::inline SHOAL_ISA_NS
