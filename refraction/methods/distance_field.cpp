// distance-field: the true refracted ray, sphere-traced through a voxel distance field of what lies beyond the surface,
// shaded from the nearest surface there. Nothing of the refracted layer is drawn; reflections are those of all methods.
//
// Source  Liu et al. 2020, reference [13]: Rodgman and Chen 2001, refraction in discretely sampled distance fields.
// Differs The field gives where a ray comes near a surface; it then hits the nearest triangle, which is shaded by its
// own
//         attributes, so that colours are not those of voxels. What is smaller than a voxel is hit only where it is
//         the nearest triangle of one. Cut-out materials are whole.
#include "refraction/field/march_field.h"
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct Options {
  int resolution = 128;
  float stop = 0.5f;
  int steps = 512;
};
constexpr MethodOption kOptions[] = {
    method_option<&Options::resolution>("resolution", 8, 512, "voxels along the field's longest side"),
    method_option<&Options::stop>("stop", 0, 4, "voxels: a ray that passes the nearest triangle no farther hits it"),
    method_option<&Options::steps>("steps", 1, 4096, "steps of a ray, at most"),
};

struct DistanceFieldMethod : TrueRays {
  static constexpr MethodCategory kCategory = MethodCategory::kVolume;

  static void prepare(const PrepareIn& in, MethodState& state) {
    if (state.data == nullptr) state.data = std::make_unique<DistanceFields>();
    static_cast<DistanceFields&>(*state.data)
        .build(in.scene, in.camera, state.options_as<Options>().resolution, in.pool);
  }

  static void narrow(const VolumeNarrowIn& in, const NarrowOut& out, std::size_t region) {
    const Options& options = in.state.options_as<Options>();
    const DistanceFields& fields = in.state.data_as<DistanceFields>();
    const DistanceField& field =
        (in.optics.exact.eye_below ? fields.above : fields.below)[static_cast<std::size_t>(in.optics.water.index)];
    const MarchSettings settings{options.stop, options.steps};
    for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
      const std::size_t at_block = block_in_region(block.x_px, block.y_px);
      const InterfaceBlock& interface = in.interface.block[at_block];
      if (interface.shows == 0) return;
      const ExactRay<WideF> at = load_interface(interface);
      const Ray<WideF> ray{at.crossing_world, at.refracted};
      const FieldHit hit = march_field(field, in.optics.body(), in.geometry, ray, settings,
                                       mask_from_bits(interface.shows & interface.transmitted));
      HitBlock& hits = out.hits[at_block];
      hit.id.store(hits.refracted_id);
      if (!in.wants_positions) return;
      hit.id.store(hits.refracted_triangle);
      store3(hits.refracted_position, ray.origin_world + ray.direction_world * hit.t);
    });
  }
};

}  // namespace

Method distance_field() {
  return ray_method<DistanceFieldMethod>(
      "distance-field", "the true refracted ray, sphere-traced through a voxel distance field",
      "Rodgman and Chen 2001, as Liu et al. 2020 [13]", option_list<Options>(kOptions));
}

}  // namespace shoal::inline SHOAL_ISA_NS
