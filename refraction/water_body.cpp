#include "refraction/water_body.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <iterator>

namespace shoal {

namespace {

// The stages that run region by region. Their time is taken on each thread and shared out by its proportions.
enum RegionStage { kInterface, kNarrow, kReflected, kBlended, kSecondary, kLight, kRegionStages };
constexpr const char* kRegionStageNames[kRegionStages] = {"interface",     "narrow",    "narrow.reflected",
                                                          "blended.water", "secondary", "shade.water"};

class RegionTimes {
 public:
  // Adds the time since the last call on this thread to a stage.
  class Lap {
   public:
    explicit Lap(RegionTimes& times) : times_(times), last_(StageClock::Clock::now()) {}
    void end(RegionStage stage) {
      const auto now = StageClock::Clock::now();
      times_.ns_[stage].fetch_add((now - last_).count(), std::memory_order_relaxed);
      last_ = now;
    }

   private:
    RegionTimes& times_;
    StageClock::Clock::time_point last_;
  };
  void lap(StageClock& clock) const {
    std::pair<const char*, double> shares[kRegionStages];
    for (int i = 0; i < kRegionStages; ++i) shares[i] = {kRegionStageNames[i], static_cast<double>(ns_[i].load())};
    clock.lap(shares);
  }

 private:
  std::array<std::atomic<std::int64_t>, kRegionStages> ns_{};
};

std::uint64_t capped(const PassBins& bins) {
  std::uint64_t sum = 0;
  for (const WorkItemBins& work_item : bins.work_items) sum += work_item.subdivision_capped;
  return sum;
}

// The layers of a direction: front end, then visibility; where the method searches them, their edges and what is
// behind.
struct LayerDraw {
  const char *front_end_stage, *visibility_stage, *edges_stage, *behind_stage;
  const char *id_digest, *depth_digest, *behind_id_digest, *behind_depth_digest;
  void (*front_end)(const LayerPassIn&, const BinsOut&, std::size_t);
  AlphaTestFunction alpha_test;
};
void draw_layer(const FrameIn& in, const ViewState& view, const WaterPass& pass, const LayerDraw& draw,
                const FrameOut& out, VisibilityBuffer& layer, VisibilityBuffer& layer_behind, const Run& run) {
  FrameWork& work = out.work;
  {
    Stage stage(run, draw.front_end_stage);
    const LayerPassIn front_end{in.scene.geometry(), view, pass, in.state};
    stage.for_each(work.bins.work_items.size(),
                   [&](std::size_t work_item) { draw.front_end(front_end, {work.bins}, work_item); });
  }
  const AlphaTestIn alpha{in.scene.shading, view.view, in.grids.frame, pass.optics, in.method.rays, in.state.options};
  const TilePassIn tiles{nullptr, work.bins, in.grids.layers.tiles, in.grids.layers.margin_px, draw.alpha_test, alpha};
  {
    Stage stage(run, draw.visibility_stage);
    stage.for_each(in.grids.layer_tile_count(), [&](std::size_t tile) {
      if (work.regions.tile_active[tile] != 0) in.kernels.draw_tile(tiles, layer, tile);
    });
  }
  run.digest({draw.id_digest, draw.depth_digest});
  if (!in.method.searches) return;

  const std::size_t kind = static_cast<std::size_t>(pass.kind);
  LayerRegions& regions = work.regions.layers;
  {
    Stage stage(run, draw.edges_stage);
    stage.for_each(regions.drawn.size(), [&](std::size_t region) {
      if (regions.drawn[region] != 0)
        in.kernels.find_edges(layer, regions.drawn.data(), work.edges[kind], region);
      else
        work.edges[kind].clear(region);
    });
  }
  if (in.method.searches_behind == nullptr || !in.method.searches_behind(in.state)) return;
  {
    // Bent rays hit triangles that face away from those of flat water.
    Stage stage(run, draw.behind_stage);
    find_behind_regions(in.grids.layers, regions.drawn, work.edges[kind], regions.behind[kind]);
    std::vector<std::int32_t>& active = work.regions.tile_active;
    for (std::size_t tile = 0; tile < active.size(); ++tile)
      active[tile] = tile_overlaps(in.grids.layers, regions.behind[kind], tile) ? 1 : 0;
    WaterPass back = pass;
    back.pass.back_faces = true;
    const LayerPassIn front_end{in.scene.geometry(), view, back, in.state};
    stage.for_each(work.back_bins.work_items.size(),
                   [&](std::size_t work_item) { draw.front_end(front_end, {work.back_bins}, work_item); });
    TilePassIn both = tiles;
    both.first = &work.back_bins;
    stage.for_each(in.grids.layer_tile_count(), [&](std::size_t tile) {
      if (active[tile] != 0) in.kernels.draw_tile_behind(both, layer, layer_behind, tile);
    });
  }
  for (std::size_t tile = 0; tile < work.regions.tile_active.size(); ++tile)
    work.regions.tile_active[tile] = tile_overlaps(in.grids.layers, regions.drawn, tile) ? 1 : 0;
  run.digest({draw.behind_id_digest, draw.behind_depth_digest});
}

// The blended meshlets of a body's pass into bins.
void bin_blended(const FrameIn& in, const ViewState& view, const WaterPass& pass, const WaterRegions& regions,
                 PassBins& bins, FrameCounts& counts, Stage& stage) {
  const BlendedPassIn blended{in.scene.geometry(),         view,    &pass, in.blended_meshlets, in.grids.layers.regions,
                              regions.layers.drawn.data(), in.state};
  const bool own_map = in.method.blended_front_end != nullptr && pass.kind == WaterPassKind::kRefracted;
  const auto front_end = own_map ? in.method.blended_front_end : in.kernels.blended_front_end;
  stage.for_each(bins.work_items.size(), [&](std::size_t work_item) { front_end(blended, {bins}, work_item); });
  counts.subdivision_capped += capped(bins);
}

// The marks of a block's pixels before the narrow phase.
void clear_marks(HitBlock& hits) {
  std::fill(std::begin(hits.fetches), std::end(hits.fetches), 0);
  hits.refracted_approximate = hits.reflected_approximate = hits.reflected_aimed = 0;
}

// Adds what the water pixels of a region fetched. Sums and maxima of integers: the order of the threads has no
// influence.
void add_fetches(const RegionScratch& scratch, FrameCounts& counts) {
  std::uint64_t sum = 0;
  std::int32_t most = 0;
  for (int b = 0; b < RegionScratch::kBlocks; ++b)
    for (std::uint32_t lanes = scratch.interface.block[b].shows; lanes != 0; lanes &= lanes - 1) {
      const std::int32_t n = scratch.hits[b].fetches[std::countr_zero(lanes)];
      sum += static_cast<std::uint64_t>(n), most = std::max(most, n);
    }
  if (sum == 0) return;
  std::atomic_ref<std::uint64_t>(counts.fetches).fetch_add(sum, std::memory_order_relaxed);
  const std::atomic_ref<std::uint32_t> max(counts.max_fetches);
  for (std::uint32_t seen = max.load(); seen < static_cast<std::uint32_t>(most);)
    if (max.compare_exchange_weak(seen, static_cast<std::uint32_t>(most))) break;
}

// The stages of one body over one region.
struct RegionPass {
  const FrameIn& in;
  const ViewState& view;
  const WaterPass& refracted;
  const WaterPass& reflected;
  const FrameOut& out;
  bool refracted_drawn, reflected_drawn;  // the body's layers

  void run(std::size_t region, std::size_t thread, RegionTimes::Lap lap) const {
    const WaterOptics& optics = *refracted.optics;
    const FrameKernels& kernels = in.kernels;
    const MethodKernels& method = in.method;
    Targets& t = out.targets;
    RegionScratch& scratch = out.work.scratch[thread];
    const bool blends = !in.blended_meshlets.empty();

    // Interface: where the view rays cross the surface.
    kernels.find_interface({in.scene, view, in.grids.frame, optics, t.direct},
                           {scratch.interface, t.interface, t.gbuffer, t.hits}, region);
    lap.end(kInterface);

    // Narrow phase: what the refracted rays show, by the method; then the reflected rays, by the method's search of the
    // planar layer or, alike for all methods, by the BVH.
    for (HitBlock& hits : scratch.hits) clear_marks(hits);
    const LightLayerIn light{in.scene, view, in.grids, optics, t.refracted};
    const LazyLayer lit_layer{light, t.layer, out.work.regions.layers.lit.data()};
    const NarrowOut found{scratch.hits, scratch.fetched, method.lights_layer ? &lit_layer : nullptr};
    const LayerBuffers refracted_layers = layers_of(WaterPassKind::kRefracted);
    const LayerView layer(refracted_layers);
    const RasterNarrowIn raster{view, in.grids, optics, scratch.interface, layer, t.layer, in.state, blends};
    method.narrow({raster, in.scene, in.trace, t.refracted, method.shown_rays}, found, region);
    lap.end(kNarrow);
    if (optics.reflections == Reflections::kTraced) {
      kernels.reflected_hits({view, in.grids, in.scene, in.trace, optics, scratch.interface,
                              reflected_drawn ? &t.reflected : nullptr, method.own_reflected, in.state, blends},
                             scratch.hits, region);
    } else if (optics.reflections == Reflections::kPlanar) {
      const LayerBuffers reflected_layers = layers_of(WaterPassKind::kReflected);
      const LayerView planar(reflected_layers);
      method.planar(
          {{view, in.grids, optics, scratch.interface, planar, t.layer, in.state, blends}, method.own_reflected}, found,
          region);
    }
    add_fetches(scratch, out.counts);
    lap.end(kReflected);

    if (blends) {
      blend(region, thread, scratch, refracted, refracted_drawn, out.work.blended_bins, t.refracted,
            t.blended_refracted);
      if (optics.reflects_scene())
        blend(region, thread, scratch, reflected, reflected_drawn, out.work.blended_reflected_bins, t.reflected,
              t.blended_reflected);
      lap.end(kBlended);
    }

    // Rays that cross a secondary interface, then the light of the water pixels.
    if (method.traces || in.reflections == Reflections::kTraced)
      kernels.trace_secondary_interfaces(
          {in.scene, in.trace, view, in.grids, optics, scratch.interface, scratch.hits, method.traces,
           method.shown_rays, method.own_reflected, in.state.options, in.reflections != Reflections::kEnvironment},
          {scratch.secondary, t.hits}, region);
    lap.end(kSecondary);
    kernels.shade_water({in.scene, view, in.grids, optics, scratch.interface, scratch.hits,
                         method.lights_layer ? scratch.fetched : nullptr, scratch.secondary,
                         blends ? &t.blended_refracted : nullptr, blends ? &t.blended_reflected : nullptr,
                         method.shown_rays, method.own_reflected, in.state.options, method.misses},
                        {t.water_light, t.hits}, region);
    lap.end(kLight);
  }

  // The layers of a direction as the narrow phase reads them.
  LayerBuffers layers_of(WaterPassKind kind) const {
    const bool mirrored = kind == WaterPassKind::kReflected;
    const Targets& t = out.targets;
    const FrameWork& work = out.work;
    const bool behind = in.method.searches_behind != nullptr && in.method.searches_behind(in.state);
    const std::size_t k = static_cast<std::size_t>(kind);
    return {.kind = kind,
            .optics = *refracted.optics,
            .view = view.view,
            .grid = in.grids.layers,
            .region_drawn = work.regions.layers.drawn.data(),
            .region_behind = work.regions.layers.behind[k].data(),
            .nearest = mirrored ? t.reflected : t.refracted,
            .behind = !behind    ? nullptr
                      : mirrored ? &t.reflected_behind
                                 : &t.refracted_behind,
            .edges = in.method.searches ? &work.edges[k] : nullptr,
            .geometry = in.scene.geometry()};
  }

  // Blended materials along the rays of one pass, in front of what they hit.
  void blend(std::size_t region, std::size_t thread, const RegionScratch& scratch, const WaterPass& pass, bool drawn,
             const PassBins& bins, VisibilityBuffer& opaque, BlendLayer& layer) const {
    if (!drawn)
      in.kernels.layer_from_hits({view, in.grids, *pass.optics, scratch.interface, scratch.hits, pass.kind}, opaque,
                                 region);
    in.kernels.blend_water(
        {in.scene, view, in.grids, bins, pass, scratch.interface, scratch.hits, in.method.rays, in.state.options},
        {opaque, layer, out.work.fragments[thread]}, region);
  }
};

}  // namespace

void draw_water_body(const FrameIn& in, const ViewState& view, const WaterOptics& optics, const FrameOut& out,
                     const Run& run) {
  const FrameKernels& kernels = in.kernels;
  Targets& t = out.targets;
  FrameWork& work = out.work;
  WaterPass refracted;
  {  // The regions that show the body.
    Stage stage(run, "water.region");
    stage.for_each(work.counts.size(), [&](std::size_t region) {
      work.counts[region] = kernels.count_water(t.direct, optics.water.index, region);
    });
    // Bent rays are searched for beyond the water pixels.
    const int widened = in.method.searches && optics.surface() != nullptr ? 1 : 0;
    const std::uint64_t pixels =
        find_region({in.grids, view, optics, work.counts, in.method.lights_layer || in.method.whole_scene, widened},
                    {work.regions, refracted});
    out.counts.water_pixels += pixels;
    if (pixels == 0) return;
  }
  const WaterPass reflected = reflected_pass(refracted);
  const bool refracted_drawn = draws_refracted_layer(in.method, optics);
  const bool reflected_drawn = draws_reflected_layer(optics);

  if (in.method.whole_scene) {
    run.digest({"visibility.refracted", "depth.refracted"});
  } else if (refracted_drawn) {
    const auto front_end =
        in.method.refracted_front_end != nullptr ? in.method.refracted_front_end : kernels.refracted_front_end;
    draw_layer(in, view, refracted,
               {"refracted.front_end", "refracted.visibility", "refracted.edges", "refracted.behind",
                "visibility.refracted", "depth.refracted", "visibility.refracted.behind", "depth.refracted.behind",
                front_end, kernels.refracted_alpha_test},
               out, t.refracted, t.refracted_behind, run);
    out.counts.subdivision_capped += capped(work.bins);
  }
  if (reflected_drawn)
    draw_layer(in, view, reflected,
               {"reflected.front_end", "reflected.visibility", "reflected.edges", "reflected.behind",
                "visibility.reflected", "depth.reflected", "visibility.reflected.behind", "depth.reflected.behind",
                kernels.reflected_front_end, kernels.reflected_alpha_test},
               out, t.reflected, t.reflected_behind, run);
  if (!in.blended_meshlets.empty()) {
    Stage stage(run, "blended.water");
    bin_blended(in, view, refracted, work.regions, work.blended_bins, out.counts, stage);
    if (optics.reflects_scene())
      bin_blended(in, view, reflected, work.regions, work.blended_reflected_bins, out.counts, stage);
  }
  std::fill(work.regions.layers.lit.begin(), work.regions.layers.lit.end(), std::int32_t{kDark});

  RegionTimes times;
  const RegionPass pass{in, view, refracted, reflected, out, refracted_drawn, reflected_drawn};
  run.pool.for_each(in.grids.frame.region_count(), [&](std::size_t region, int thread) {
    if (work.regions.of_body[region] != 0) pass.run(region, static_cast<std::size_t>(thread), RegionTimes::Lap(times));
  });
  times.lap(run.clock);
  if (in.method.lights_layer) run.digest({"layer"});
}

void draw_scene_then_water(const FrameIn& in, const TilePassIn& pass, const FrameOut& out, Stage& stage) {
  TilePassIn scene = pass;
  scene.first = nullptr;
  const TilePassIn water{nullptr, out.work.outline_bins, pass.tiles, pass.margin_px, pass.alpha_test, pass.alpha};
  Targets& t = out.targets;
  stage.for_each(in.grids.tile_count(), [&](std::size_t tile) {
    in.kernels.draw_tile(scene, t.refracted, tile);
    in.kernels.draw_tile_over(water, t.refracted, t.direct, tile);
  });
}

void blend_in_front(const FrameIn& in, const ViewState& view, const FrameOut& out, const Run& run) {
  Stage stage(run, "blended.direct");
  FrameWork& work = out.work;
  const BlendedPassIn blended{in.scene.geometry(),  view,    nullptr, in.blended_meshlets,
                              work.blended_regions, nullptr, in.state};
  stage.for_each(work.blended_bins.work_items.size(),
                 [&](std::size_t work_item) { in.kernels.blended_front_end(blended, {work.blended_bins}, work_item); });
  const BlendDirectIn direct{in.scene, view, in.grids, work.blended_bins};
  stage.for_each_on_thread(in.grids.frame.region_count(), [&](std::size_t region, int thread) {
    in.kernels.blend_direct(
        direct, {out.targets.direct, out.targets.blended_direct, work.fragments[static_cast<std::size_t>(thread)]},
        region);
  });
}

void trace_pixels(const FrameIn& in, const ViewState& view, const FrameOut& out, const Run& run) {
  Targets& t = out.targets;
  {
    Stage stage(run, "trace");
    const TraceIn trace{
        in.scene, in.trace, view, in.grids, out.work.water, in.state, in.reflections != Reflections::kEnvironment,
        in.post};
    const TraceOut traced{t.direct, t.gbuffer,      t.hits,          t.interface,
                          t.lit,    t.srgb8.data(), out.counts.rays, out.counts.water_pixels};
    stage.for_each(in.grids.frame.region_count(), [&](std::size_t region) { in.method.trace(trace, traced, region); });
  }
  run.digest({"visibility.direct", "depth.direct", "interface", "gbuffer", "hit"});
}

}  // namespace shoal
