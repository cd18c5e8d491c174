#include "refraction/renderer.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/float_mode.h"
#include "core/thread_pool.h"
#include "raster/geometry_view.h"
#include "refraction/aov.h"
#include "refraction/passes/blend.h"
#include "refraction/frame.h"
#include "refraction/methods/options.h"
#include "refraction/data/sample_positions.h"
#include "refraction/stage_digests.h"
#include "refraction/passes/water_region.h"

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

constexpr const char* kRayNames[RayCounts::kKinds] = {"primary", "reflected", "refracted", "shadow"};

}  // namespace

struct Renderer::Impl {
  std::unique_ptr<RenderScene> moved;  // the renderer's own, where the scene is animated
  const RenderScene& scene;
  const FrameKernels& kernels;
  const Method& method;
  ThreadPool pool;
  FrameData frame;
  Geometry outlines;  // of the bodies of water
  Materials outline_materials;
  std::vector<Material> filtered_materials;  // the scene's with the frame's texture filtering, where that is not theirs
  StageClock clock;

  Impl(const RenderScene& s, const FrameSettings& settings)
      : moved(s.moves() ? std::make_unique<RenderScene>(s) : nullptr),
        scene(moved ? *moved : s),
        kernels(frame_kernels(settings.isa)),
        method(find_method(settings.method, settings.isa)),
        pool(settings.threads > 0 ? settings.threads : available_threads()) {
    build_outlines();
    FrameData& f = frame;
    f.scene = &scene;
    f.settings = settings;
    f.grid = make_frame_grid(settings.width_px, settings.height_px);
    f.bin_grid = make_bin_grid(settings.width_px, settings.height_px, settings.tile_px);
    const bool waves = std::any_of(scene.waters.begin(), scene.waters.end(),
                                   [](const WaterBody& body) { return body.surface.kind != SurfaceKind::kFlat; });
    const bool looks_along_waves = waves && method.kernels.light_layer != nullptr;
    f.layers = make_layer_grid(f.grid, settings.tile_px, looks_along_waves ? kWaveMargin_px : 0);
    f.geometry = view_of(scene.geometry, scene.materials);
    f.water_geometry = view_of(outlines, outline_materials);
    filter_materials();
    f.bins = make_bins(scene.geometry.meshlets.size());
    f.water_bins.work_items.resize(scene.waters.size());
    if (!scene.waters.empty() && method.kernels.trace == nullptr) {
      f.tree = std::make_unique<Bvh16>();
      f.tree->build(scene.geometry, scene.materials, waves, pool);
    }
    read_method_options(method, settings.method_options, f.method_option);
    if (method.kernels.trace != nullptr || settings.shadows == Shadows::kRays) {
      f.rays = make_ray_queries(scene, pool.threads());
      if (f.rays == nullptr) throw UsageError("this build has no ray tracer; expected a method that is not ray-traced");
    }
    find_blended(f, pool.threads());
    if (!moved) build_shadows(f, kernels, pool);
    if (!moved && method.kernels.prepare != nullptr) method.kernels.prepare(f, pool, nullptr);
    for (const WaterBody& body : scene.waters)
      f.surface_models.push_back(make_surface_model(body.surface, plane_extent(body)));
    allocate();
  }

  // Each body's outline as drawable of its own, seen from both sides.
  void build_outlines() {
    Material surface;
    surface.double_sided = true;
    outline_materials.materials.assign(1, surface);
    outlines = Geometry{};
    std::vector<std::uint32_t>& first_meshlet = frame.outline_first_meshlet;
    first_meshlet.clear();
    for (const WaterBody& body : scene.waters) {
      first_meshlet.push_back(static_cast<std::uint32_t>(outlines.meshlets.size()));
      const std::vector<Vec3f> normals(body.outline.size(), body.normal);
      std::vector<std::uint32_t> indices(body.outline.size());
      for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
      MeshView mesh;
      mesh.positions_world = body.outline.data();
      mesh.normals_world = normals.data();
      mesh.indices = indices.data();
      mesh.vertex_count = mesh.index_count = static_cast<std::uint32_t>(indices.size());
      append_mesh(outlines, mesh);
    }
    first_meshlet.push_back(static_cast<std::uint32_t>(outlines.meshlets.size()));
  }

  // Every pass reads its samplers from the view's materials.
  void filter_materials() {
    if (frame.settings.anisotropy == 1) return;
    filtered_materials = scene.materials.materials;
    for (Material& m : filtered_materials) m.set_anisotropy(frame.settings.anisotropy);
    frame.geometry.materials = filtered_materials.data();
  }

  bool captures() const { return frame.settings.digests || frame.settings.aovs != 0; }

  void allocate() {
    FrameData& f = frame;
    f.direct.resize(f.grid);
    const std::size_t regions = static_cast<std::size_t>(f.grid.regions_x) * static_cast<std::size_t>(f.grid.regions_y);
    f.region_of_body.resize(regions);
    f.layer_regions.resize(f.layers.grid.region_count());
    f.tile_active.resize(static_cast<std::size_t>(f.layers.tiles.tiles_x) *
                         static_cast<std::size_t>(f.layers.tiles.tiles_y));
    if (!scene.waters.empty()) {
      f.refracted.resize(f.layers.grid);
      f.mirrored.resize(f.layers.grid);
      f.hits.resize(f.grid);
      if (method.kernels.light_layer != nullptr) f.layer.resize(f.grid), f.fetched.resize(f.grid);
    }
    if (captures()) {
      for (auto& plane : f.gbuffer.plane) plane.resize(f.grid.pixel_slots());
      HitPoints& h = f.hit_points;
      for (auto* plane : {&h.x_world, &h.y_world, &h.z_world, &h.virtual_x, &h.virtual_y, &h.virtual_z})
        plane->resize(f.grid.pixel_slots());
      h.kind.resize(f.grid.pixel_slots());
      h.id.resize(f.grid.pixel_slots());
      h.outside.resize(f.grid.pixel_slots());
    }
    if (f.settings.spp > 1 || f.settings.digests || f.settings.keep_linear)
      for (auto* plane : {&f.lit.red, &f.lit.green, &f.lit.blue, &f.lit.alpha}) plane->resize(f.grid.pixel_slots());
  }

  void set_sample(const Camera& camera, Vec2f offset_px) {
    FrameData& f = frame;
    f.view = make_view(camera, f.settings.width_px, f.settings.height_px, offset_px);
    f.frustum = make_frustum(f.view, 0, 0, f.settings.width_px - 1, f.settings.height_px - 1);
    PassSettings& p = f.direct_pass;
    p = PassSettings{};
    p.width_px = f.settings.width_px, p.height_px = f.settings.height_px;
    p.centre_px = f.view.centre_px;
    p.grid = f.bin_grid;
    p.x_max = f.settings.width_px - 1, p.y_max = f.settings.height_px - 1;
    p.skip_blended = f.blended.any();
  }

  void sample(StageDigests* digests) { render_sample(frame, kernels, method.kernels, pool, clock, digests); }

  // Animated scenes: what moves, where it is at this time.
  void move(const Camera& camera, double time_s) {
    update_render_scene(*moved, time_s, &pool);
    if (!scene.waters.empty()) {
      build_outlines();
      frame.water_geometry = view_of(outlines, outline_materials);
    }
    clock.lap("animate");
    if (frame.rays != nullptr) frame.rays->update(), clock.lap("rays.build");
    if (frame.tree != nullptr) frame.tree->refit(scene.geometry, pool), clock.lap("tree.build");
    build_shadows(frame, kernels, pool);
    clock.lap("shadow.map");
    if (method.kernels.prepare != nullptr) method.kernels.prepare(frame, pool, &camera), clock.lap("method.build");
  }

  void render(const Camera& camera, double time_s, Frame& out) {
    const FloatModeGuard mode;
    FrameData& f = frame;
    StageDigests digests;
    StageDigests* wanted = f.settings.digests ? &digests : nullptr;
    clock.reset();
    if (moved) move(camera, time_s);
    f.water_pixels = f.subdivision_capped = 0;
    f.ray_counts = RayCounts();
    f.time_s = time_s;
    f.surfaces.clear();
    for (const SurfaceModel& model : f.surface_models) f.surfaces.push_back(prepare_surface(model, time_s));
    clock.lap("water");
    f.srgb8.resize(static_cast<std::size_t>(f.settings.width_px) * static_cast<std::size_t>(f.settings.height_px) * 3);
    if (wanted != nullptr) digests.shadow(f), clock.skip();
    f.sample_count = f.settings.spp;
    f.sample = 0;
    if (f.settings.spp > 1) {
      // Buffers beside the picture are those of the pixels' centres.
      if (captures()) {
        set_sample(camera, {0, 0});
        f.capture = true, f.accumulate = false, f.last_sample = false;
        sample(wanted);
        out.water_pixels = f.water_pixels;
        copy_aovs(f, scene, out);
        f.ray_counts = RayCounts();
        clock.skip();
      }
      f.capture = false, f.accumulate = true;
      for (int s = 0; s < f.settings.spp; ++s) {
        set_sample(camera, sample_position(s, f.settings.spp));
        f.sample = s;
        f.last_sample = s + 1 == f.settings.spp;
        f.water_pixels = 0;
        sample(nullptr);
        if (s == 0 && !captures()) out.water_pixels = f.water_pixels;
      }
    } else {
      set_sample(camera, {0, 0});
      f.capture = captures(), f.accumulate = true, f.last_sample = true;
      sample(wanted);
      out.water_pixels = f.water_pixels;
    }
    out.width_px = f.settings.width_px, out.height_px = f.settings.height_px;
    if (f.settings.spp == 1) copy_aovs(f, scene, out);
    if (f.settings.keep_linear) copy_linear(f, out);
    if (wanted != nullptr) digests.picture(f);
    // The picture changes hands; the caller's old one is the next frame's memory.
    std::swap(out.srgb8, f.srgb8);
    out.digests = digests.list();
    out.stages_ms = clock.stages();
    out.frame_ms = clock.total_ms();
    out.subdivision_capped = f.subdivision_capped;
    out.method_figures.clear();
    if (f.fields != nullptr)
      out.method_figures = {{"field_build_ms", f.fields->build_ms},
                            {"field_mb", static_cast<double>(f.fields->bytes()) / 1048576.0}};
    out.rays.clear();
    if (f.rays != nullptr)
      for (int kind = 0; kind < RayCounts::kKinds; ++kind)
        out.rays.emplace_back(kRayNames[kind], f.ray_counts.of[kind]);
  }
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
