#include "refraction/renderer.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/float_mode.h"
#include "raster/geometry_view.h"
#include "refraction/aov.h"
#include "refraction/data/sample_positions.h"
#include "refraction/frame.h"
#include "scene/light_medium.h"
#include "scene/sun_bend.h"
#include "trace/sun_blocked.h"
#include "water/prepare_surface.h"

namespace shoal {

namespace {

void check(bool ok, const std::string& what) {
  if (!ok) throw UsageError(what);
}

void check_settings(const FrameSettings& s, const RenderScene& scene) {
  check(s.width_px >= 1 && s.width_px <= 16384 && s.height_px >= 1 && s.height_px <= 16384,
        "size " + std::to_string(s.width_px) + "x" + std::to_string(s.height_px) +
            " is out of range; expected 1x1 to 16384x16384");
  check(s.spp >= 1 && s.spp <= 256, "spp " + std::to_string(s.spp) + " is out of range; expected 1 to 256");
  check(s.threads >= 0 && s.threads <= 256,
        "threads " + std::to_string(s.threads) + " is out of range; expected 1 to 256");
  check(s.tile_px >= 16 && s.tile_px <= 256 && (s.tile_px & (s.tile_px - 1)) == 0,
        "tile " + std::to_string(s.tile_px) + " is not allowed; expected a power of two from 16 to 256");
  check(s.anisotropy >= 1 && s.anisotropy <= 16,
        "anisotropy " + std::to_string(s.anisotropy) + " is out of range; expected 1 to 16");
  check(s.shadow_map_px >= 256 && s.shadow_map_px <= 8192 && (s.shadow_map_px & (s.shadow_map_px - 1)) == 0,
        "shadow map size " + std::to_string(s.shadow_map_px) +
            " is not allowed; expected a power of two from 256 to 8192");
  check(s.exposure_stops >= -100.0f && s.exposure_stops <= 100.0f,
        "exposure is out of range; expected -100 to 100 stops");
  const std::vector<Isa> isas = supported_isas();
  check(std::find(isas.begin(), isas.end(), s.isa) != isas.end(),
        std::string("isa ") + isa_name(s.isa) +
            (is_built(s.isa) ? " does not run on this machine" : " is not in this build"));
  check(scene.geometry.triangles.size() < static_cast<std::size_t>(kNoId),
        "the scene has too many triangles; expected fewer than 2147483647");
  check(scene.waters.size() < static_cast<std::size_t>(kMaxWaterBodies), "the scene has too many bodies of water");
}

// The meshlets of blended materials, in submission order.
std::vector<std::uint32_t> blended_meshlets(const RenderScene& scene) {
  std::vector<std::uint32_t> found;
  for (std::size_t m = 0; m < scene.geometry.meshlets.size(); ++m)
    if (scene.materials.materials[scene.geometry.meshlets[m].material].alpha_mode == AlphaMode::kBlend)
      found.push_back(static_cast<std::uint32_t>(m));
  return found;
}

bool has_waves(const RenderScene& scene) {
  return std::any_of(scene.waters.begin(), scene.waters.end(),
                     [](const WaterBody& body) { return body.surface.kind != SurfaceKind::kFlat; });
}

// Each body's outline as a drawable of its own, seen from both sides.
struct Outlines {
  Geometry geometry;
  std::vector<DrawState> draw_states{DrawState{true, false, false}};
  std::vector<std::uint32_t> first_meshlet;  // of body b; one more at the end
  std::vector<Vec3f> vertices;               // of all bodies

  void build(const std::vector<WaterBody>& bodies) {
    geometry = Geometry{};
    first_meshlet.clear(), vertices.clear();
    for (const WaterBody& body : bodies) {
      first_meshlet.push_back(static_cast<std::uint32_t>(geometry.meshlets.size()));
      const std::vector<Vec3f> normals(body.outline.size(), body.normal);
      std::vector<std::uint32_t> indices(body.outline.size());
      for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
      MeshView mesh;
      mesh.positions_world = body.outline.data();
      mesh.normals_world = normals.data();
      mesh.indices = indices.data();
      mesh.vertex_count = mesh.index_count = static_cast<std::uint32_t>(indices.size());
      append_mesh(geometry, mesh);
      vertices.insert(vertices.end(), body.outline.begin(), body.outline.end());
    }
    first_meshlet.push_back(static_cast<std::uint32_t>(geometry.meshlets.size()));
  }
  OutlineView view() const {
    return {view_of(geometry, draw_states.data()), first_meshlet.data(), first_meshlet.size() - 1};
  }
};

}  // namespace

struct Renderer::Impl {
  std::unique_ptr<RenderScene> moved;  // the renderer's own copy, where the scene is animated
  const RenderScene& scene;
  const FrameSettings settings;
  const Reflections reflections;
  const FrameKernels& kernels;
  const Method& method;
  MethodState state;
  ThreadPool pool;
  StageClock clock;

  // What the views of the scene refer to.
  Outlines outlines;
  std::vector<DrawState> states;
  std::vector<Material> materials;  // with the frame's texture filtering
  SunShadows shadows;
  std::vector<SurfaceModel> surface_models;  // of the bodies
  std::vector<WaterSurface> surfaces;        // at this time
  std::vector<PlacedWater> water;
  std::vector<LightMedium> light_media;
  Bvh16 bvh, blended_bvh;
  TracedShadows traced_shadows;
  SceneView view;
  OutlineView outline_view;
  TraceView trace;

  // The frame's own.
  std::vector<std::uint32_t> blended;
  FrameGrids grids;
  TargetNeeds needs;
  Targets targets;
  FrameWork work;
  FrameCounts counts;
  ViewState view_state;

  Impl(const RenderScene& s, const FrameSettings& given)
      : moved(s.moves() ? std::make_unique<RenderScene>(s) : nullptr),
        scene(moved ? *moved : s),
        settings(given),
        reflections(given.reflections.value_or(default_reflections(find_method(given.method, given.isa).category))),
        kernels(frame_kernels(given.isa)),
        method(find_method(given.method, given.isa)),
        pool(given.threads > 0 ? given.threads : available_threads()),
        states(draw_states(scene.materials.materials)),
        materials(scene.materials.materials),
        blended(blended_meshlets(scene)) {
    if (settings.anisotropy != 1)
      for (Material& m : materials) m.set_anisotropy(settings.anisotropy);
    const bool waves = has_waves(scene);
    grids = make_frame_grids(settings.width_px, settings.height_px, settings.tile_px,
                             waves && method.kernels.searches ? kWaveMargin_px : 0);
    read_method_options(method.name, method.options, settings.method_options, state);
    outlines.build(scene.waters);
    build_trace(waves);
    view_scene();
    if (!moved) {
      build_sun_shadows();
      prepare_method(nullptr);
    }
    for (const WaterBody& body : scene.waters)
      surface_models.push_back(make_surface_model(body.surface, plane_extent(body)));
    allocate_frame();
  }

  bool captures() const { return settings.digests || settings.aovs != 0; }
  bool has_water() const { return !scene.waters.empty(); }

  bool traces_all() const { return method.kernels.trace != nullptr; }
  // Rays that the frame counts: those of the reference and of traced shadows.
  bool counts_rays() const { return traces_all() || settings.shadows == Shadows::kRays; }

  // The BVHs that rays are traced against; none where no ray is traced. Corners are kept where every pixel traces rays.
  void build_trace(bool waves) {
    const bool traced_water = method.kernels.traces || reflections == Reflections::kTraced;
    if (!(has_water() && traced_water) && !counts_rays()) return;
    bvh.build(scene.geometry, scene.materials, Bvh16::Content::kOpaque, waves || counts_rays(), pool);
    trace.bvh = &bvh;
    if (!traces_all() || blended.empty()) return;
    blended_bvh.build(scene.geometry, scene.materials, Bvh16::Content::kBlended, true, pool);
    trace.blended = &blended_bvh;
  }

  // The views of the scene, anew where the scene's arrays may have moved.
  void view_scene() {
    ShadingView& shading = view.shading;
    shading.geometry = view_of(scene.geometry, states.data());
    shading.materials = materials.data();
    shading.textures = scene.materials.textures.data();
    shading.lighting = &scene.lighting;
    shading.sun_shadows = &shadows;
    traced_shadows = {&shading, trace.bvh, &counts.rays};
    if (settings.shadows == Shadows::kRays) shading.shadow_rays = {kernels.sun_blocked, &traced_shadows};
    view.drawables = scene.geometry.drawables;
    view.triangle_count = static_cast<std::int32_t>(scene.geometry.triangles.size());
    outline_view = outlines.view();
  }

  void build_sun_shadows() {
    shadows = SunShadows();
    if (settings.shadows == Shadows::kMap && !scene.lighting.directional.empty()) {
      std::vector<SunBend> bends;
      for (const WaterBody& body : scene.waters)
        bends.push_back(bend_of(body, scene.lighting.directional[0].direction_world));
      build_shadows(
          {view.shading, scene.geometry.meshlets, materials.size(), bends, outlines.vertices, settings.shadow_map_px},
          shadows, pool, kernels.shadow);
    }
    light_media.clear();
    for (std::size_t b = 0; b < scene.waters.size(); ++b)
      light_media.push_back(light_medium(scene.waters[b], scene.lighting, shadows.map_index(b)));
    view.light_media = light_media.data();
  }

  void prepare_method(const Camera* camera) {
    if (method.kernels.prepare != nullptr) method.kernels.prepare({scene, camera, pool}, state);
  }

  void allocate_frame() {
    needs.water = has_water();
    needs.lit_layer = method.kernels.lights_layer;
    needs.behind = method.kernels.searches_behind != nullptr && method.kernels.searches_behind(state);
    needs.blended = !blended.empty();
    needs.capture = captures();
    needs.linear = settings.spp > 1 || settings.digests || settings.keep_linear;
    allocate(targets, grids, needs);
    const std::size_t threads = static_cast<std::size_t>(pool.threads());
    work.bins = make_bins(scene.geometry.meshlets.size());
    if (needs.behind) work.back_bins = make_bins(scene.geometry.meshlets.size());
    work.outline_bins.work_items.resize(scene.waters.size());
    work.counts.resize(grids.frame.region_count());
    work.regions.resize(grids);
    if (needs.water && method.kernels.searches)
      for (EdgeMap& edges : work.edges) edges.resize(grids.layers.grid);
    if (needs.water) {
      work.scratch.resize(threads);
      std::memset(static_cast<void*>(work.scratch.data()), 0, threads * sizeof(RegionScratch));
    }
    if (!needs.blended) return;
    work.blended_bins = make_bins(blended.size());
    if (needs.water) work.blended_reflected_bins = make_bins(blended.size());
    work.blended_regions = make_bin_grid(settings.width_px, settings.height_px, kRegionSize);
    work.fragments.resize(threads);
    for (FragmentLists& lists : work.fragments) lists.allocate();
  }

  // The camera of one sample.
  void set_sample(const Camera& camera, Vec2f offset_px) {
    ViewState& v = view_state;
    const int width = settings.width_px, height = settings.height_px;
    v.view = make_view(camera, width, height, offset_px);
    v.frustum = make_frustum(v.view, 0, 0, width - 1, height - 1);
    PassSettings& p = v.direct_pass;
    p = PassSettings{};
    p.width_px = width, p.height_px = height;
    p.centre_px = v.view.centre_px;
    p.grid = grids.tiles;
    p.x_max = width - 1, p.y_max = height - 1;
    p.skip_blended = !blended.empty();
  }

  void sample(StageDigests* digests) {
    if (view_state.capture) {
      clear_captured(targets);
      clock.skip();
    }
    const FrameIn in{
        view,
        trace,
        outline_view,
        blended,
        grids,
        kernels,
        method.kernels,
        state,
        reflections,
        {settings.exposure_stops, settings.tone_map == ToneMap::kAces ? ToneCurve::kAces : ToneCurve::kNone}};
    draw_sample(in, view_state, {targets, work, counts, view_state.eye_in_water}, {pool, clock, digests});
  }

  // An animated scene at a time, and all that follows its geometry.
  void move(const Camera& camera, double time_s) {
    update_render_scene(*moved, time_s, &pool);
    if (has_water()) outlines.build(scene.waters);
    view_scene();
    clock.lap("animate");
    if (trace.bvh != nullptr) bvh.refit(scene.geometry, pool);
    if (trace.blended != nullptr) blended_bvh.refit(scene.geometry, pool);
    if (trace.bvh != nullptr) clock.lap("bvh.refit");
    build_sun_shadows();
    clock.lap("shadow.map");
    if (method.kernels.prepare != nullptr) prepare_method(&camera), clock.lap("method.build");
  }

  // The surfaces of the bodies at a time.
  void place_surfaces(double time_s) {
    surfaces.clear(), water.clear();
    for (const SurfaceModel& model : surface_models) surfaces.push_back(prepare_surface(model, time_s));
    for (std::size_t b = 0; b < scene.waters.size(); ++b) {
      const WaterBody& body = scene.waters[b];
      const bool flat = body.surface.kind == SurfaceKind::kFlat;
      water.push_back({&body, flat ? nullptr : &surfaces[b], static_cast<std::int32_t>(b)});
    }
    view.water = water;
  }

  void render(const Camera& camera, double time_s, Frame& out) {
    const FloatModeGuard mode;
    StageDigests digests(targets, needs, grids, work.regions.layers);
    StageDigests* wanted = settings.digests ? &digests : nullptr;
    clock.reset();
    if (moved) move(camera, time_s);
    counts = FrameCounts();
    place_surfaces(time_s);
    clock.lap("water");
    targets.srgb8.resize(static_cast<std::size_t>(settings.width_px) * static_cast<std::size_t>(settings.height_px) *
                         3);
    if (wanted != nullptr) digests.add_shadows(shadows), clock.skip();
    ViewState& v = view_state;
    v.sample_count = settings.spp;
    v.sample = 0;
    if (settings.spp > 1) {
      // Buffers beside the picture are those of the pixels' centres.
      if (captures()) {
        set_sample(camera, {0, 0});
        v.capture = true, v.accumulate = false, v.last_sample = false;
        sample(wanted);
        out.water_pixels = counts.water_pixels;
        copy_aovs(aov_in(), settings.aovs, out);
        counts.rays = RayCounts();
        clock.skip();
      }
      v.capture = false, v.accumulate = true;
      for (int s = 0; s < settings.spp; ++s) {
        set_sample(camera, sample_position(s, settings.spp));
        v.sample = s;
        v.last_sample = s + 1 == settings.spp;
        counts.water_pixels = 0, counts.fetches = 0;
        sample(nullptr);
        if (s == 0 && !captures()) out.water_pixels = counts.water_pixels;
      }
    } else {
      set_sample(camera, {0, 0});
      v.capture = captures(), v.accumulate = true, v.last_sample = true;
      sample(wanted);
      out.water_pixels = counts.water_pixels;
    }
    out.width_px = settings.width_px, out.height_px = settings.height_px;
    if (settings.spp == 1) copy_aovs(aov_in(), settings.aovs, out);
    if (settings.keep_linear) copy_linear(targets, grids.frame, out);
    if (wanted != nullptr) digests.add("lit"), digests.add_picture();
    // The picture changes hands; the caller's old one is the next frame's memory.
    std::swap(out.srgb8, targets.srgb8);
    out.digests = digests.list();
    out.stages_ms = clock.stages();
    out.frame_ms = clock.total_ms();
    out.subdivision_capped = counts.subdivision_capped;
    out.max_fetches = counts.max_fetches;
    out.mean_fetches =
        counts.water_pixels == 0 ? 0 : static_cast<double>(counts.fetches) / static_cast<double>(counts.water_pixels);
    out.method_figures.clear();
    if (state.data != nullptr) out.method_figures = state.data->figures();
    out.rays.clear();
    if (counts_rays())
      for (int kind = 0; kind < RayCounts::kKinds; ++kind) out.rays.emplace_back(kRayNames[kind], counts.rays.of[kind]);
  }

  AovIn aov_in() const { return {scene, view_state.view, grids.frame, targets, work.water}; }
};

Renderer::Renderer(const RenderScene& scene, const FrameSettings& settings) {
  check_settings(settings, scene);
  const FloatModeGuard mode;
  impl_ = std::make_unique<Impl>(scene, settings);
}
Renderer::~Renderer() = default;

void Renderer::render(const Camera& camera, double time_s, Frame& frame) { impl_->render(camera, time_s, frame); }
int Renderer::threads() const { return impl_->pool.threads(); }

std::string picture_digest(const Frame& frame) { return digest_hex(frame.srgb8.data(), frame.srgb8.size()); }

}  // namespace shoal
