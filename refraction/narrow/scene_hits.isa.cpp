// Hits of refracted and reflected rays, by layer and BVH (refraction/narrow/scene_hits.h).
#include "refraction/narrow/scene_hits.h"

#include <optional>

#include "refraction/narrow/confirm_hit.h"
#include "refraction/narrow/layer_edges.h"
#include "trace/nearest_hit.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// One direction's hits of one region.
class HitSearch {
 public:
  //   layer  drawn by these rays' map and valid; null: the BVH alone
  HitSearch(const SceneView& scene, const TraceView& trace, const FrameGrids& grids, const WaterOptics& optics,
            const VisibilityBuffer* layer, std::size_t region)
      : scene_(scene),
        trace_(trace),
        grids_(grids),
        optics_(optics),
        layer_(layer),
        layer_region_(grids.layers.region(grids.frame, region)),
        crosses_water_(scene.water.size() > 1 || is_displaced(optics)) {}

  // The nearest triangle of each lane's ray.
  NearestHit nearest(const Block& block, const PixelRays<WideF>& rays, WideM lanes) {
    NearestHit known;
    if (layer_ != nullptr) {
      const LayerGrid& grid = grids_.layers;
      const WideI own = WideI::load(layer_->id.data() + grid.offset(block.x_px, block.y_px));
      const WideI x = WideI(block.x_px + grid.margin_px) + block_x(),
                  y = WideI(block.y_px + grid.margin_px) + block_y();
      const ConfirmedHit shown = confirm_hit(scene_.geometry(), *layer_, rays.ray, own, x, y, lanes);
      if (!edges_) edges_ = find_edges(*layer_, layer_region_);
      lanes = lanes & !shown.bare;
      known.id = select(shown.held, shown.id, known.id);
      const bool at_edge = edges_->at(block.x_px, block.y_px);
      if (!at_edge) lanes = lanes & !shown.held;
      if ((at_edge || crosses_water_) && any(shown.held))
        known.t = select(shown.held, triangle_distance(scene_.geometry(), rays.ray, shown.id, shown.held), known.t);
      if (none(lanes)) return known;
    }
    return nearest_hits(*trace_.bvh, scene_.shading, rays.ray, rays.differential, known, lanes);
  }

  // The hit's triangle, or the water that the ray crosses before it.
  WideI or_water(const NearestHit& hit, const ExactRay<WideF>& at, const Ray<WideF>& ray, bool reflected,
                 WideM lanes) const {
    if (!crosses_water_ || none(lanes)) return hit.id;
    const WaterCrossing water = nearest_water(scene_.water, onward_query(optics_, at, ray, reflected, lanes));
    return select(lanes & (water.t < hit.t), WideI(kFirstWaterId) + water.body, hit.id);
  }

 private:
  const SceneView& scene_;
  const TraceView& trace_;
  const FrameGrids& grids_;
  const WaterOptics& optics_;
  const VisibilityBuffer* layer_;
  std::size_t layer_region_;
  bool crosses_water_;  // rays may cross another interface
  std::optional<EdgeBlocks> edges_;
};

}  // namespace

void refracted_hits(const HybridNarrowIn& in, bool bent, HitBlock* hits, std::size_t region) {
  const bool valid = visibility_layer_valid(bent, in.optics);
  HitSearch search(in.scene, in.trace, in.grids, in.optics, valid ? &in.refracted : nullptr, region);
  for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    const std::size_t at_block = block_in_region(block.x_px, block.y_px);
    const InterfaceBlock& interface = in.interface.block[at_block];
    if (interface.shows == 0) return;
    HitBlock& out = hits[at_block];
    const WideM through = mask_from_bits(interface.shows & interface.transmitted);
    const PixelRays<WideF> rays = refracted_rays(
        in.rays, {in.view.view, in.grids.frame, in.optics, block.x_px, block.y_px, interface, out, in.state.options});
    const NearestHit hit = search.nearest(block, rays, through);
    if (!valid && in.wants_positions) {
      hit.id.store(out.refracted_triangle);
      store3(out.refracted_position, rays.ray.origin_world + rays.ray.direction_world * hit.t);
    }
    (bent ? search.or_water(hit, load_interface(interface), rays.ray, false, through) : hit.id).store(out.refracted_id);
  });
}

void reflected_hits(const ReflectedHitsIn& in, HitBlock* hits, std::size_t region) {
  HitSearch search(in.scene, in.trace, in.grids, in.optics, in.reflected, region);
  for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    const std::size_t at_block = block_in_region(block.x_px, block.y_px);
    const InterfaceBlock& interface = in.interface.block[at_block];
    if (interface.shows == 0) return;
    HitBlock& out = hits[at_block];
    const WideM here = mask_from_bits(interface.shows);
    const ExactRay<WideF> at = load_interface(interface);
    const PixelRays<WideF> rays = reflected_rays(
        in.own_rays,
        {in.view.view, in.grids.frame, in.optics, block.x_px, block.y_px, interface, out, in.state.options}, at);
    const NearestHit hit = search.nearest(block, rays, here);
    if (in.reflected == nullptr && in.wants_positions) {
      hit.id.store(out.reflected_triangle);
      store3(out.reflected_position, rays.ray.origin_world + rays.ray.direction_world * hit.t);
    }
    search.or_water(hit, at, rays.ray, true, here).store(out.reflected_id);
  });
}

}  // namespace shoal::inline SHOAL_ISA_NS
