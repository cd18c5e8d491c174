// distance-field: the true refracted ray, sphere-traced through a voxel distance field of what lies beyond the surface,
// shaded from the nearest surface there. Nothing of the refracted layer is drawn; reflections are the mirrored pass.
//
// Source  Liu et al. 2020, reference [13]: Rodgman and Chen 2001, refraction in discretely sampled distance fields.
// Differs The field says where a ray comes near a surface; what it then meets is the nearest triangle, shaded by its
// own
//         attributes, so that colours are not those of voxels. What is smaller than a voxel is met only where it is
//         the nearest triangle of one. Cut-out materials are whole.
#include "refraction/field/march_field.h"
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

enum Option { kResolution, kStop, kSteps, kOptionCount };
constexpr MethodOption kOptions[kOptionCount] = {
    {"resolution", "128", "voxels along the field's longest side", MethodOption::Kind::kInt, 8, 512},
    {"stop", "0.5", "voxels: a ray that passes the nearest triangle no farther meets it", MethodOption::Kind::kFloat, 0,
     4},
    {"steps", "512", "of a ray, at most", MethodOption::Kind::kInt, 1, 4096},
};

struct DistanceFieldMethod : TrueRays {};
using Stages = MethodStages<DistanceFieldMethod>;

void prepare(FrameData& f, ThreadPool& pool, const Camera* camera) {
  if (f.fields == nullptr) f.fields = std::make_unique<DistanceFields>();
  f.fields->build(*f.scene, camera, static_cast<int>(f.method_option[kResolution]), pool);
}

void narrow(FrameData& f, const WaterPass& water, std::size_t region) {
  const RayDifferential<WideF> differential = pixel_ray_differential<WideF>(f.view);
  const std::vector<DistanceField>& fields = water.optics.eye_below ? f.fields->above : f.fields->below;
  const DistanceField& field = fields[static_cast<std::size_t>(water.index)];
  const MarchSettings settings{f.method_option[kStop], static_cast<int>(f.method_option[kSteps])};
  NarrowPhase phase(f, water, region);
  for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    const WideM here = water_lanes(f, water, block);
    if (none(here)) return;
    const WaterRays<WideF> rays = TrueRays::rays(water, block_rays(f.view, block), differential);
    const FieldHit hit =
        march_field(field, *water.body, f.geometry, rays.refracted, settings, here & rays.at_surface.transmitted);
    store_masked(f.hits.refracted_id.data() + block.offset, hit.id, here);
    const Ray<WideF>& ray = rays.refracted;
    if (f.blended.any())
      note_layer(f, water, false, hit.id, ray.origin_world + ray.direction_world * hit.t, block);
    phase.mirror(block, rays, here);
  });
}

}  // namespace

Method distance_field() {
  return {"distance-field",
          "the true refracted ray, sphere-traced through a voxel distance field",
          "Rodgman and Chen 2001, as Liu et al. 2020 [13]",
          Stages::kernels_without_layer(&narrow, &prepare),
          kOptions,
          kOptionCount};
}

}  // namespace shoal::inline SHOAL_ISA_NS
