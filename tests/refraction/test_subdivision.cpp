// The refracted pass's geometry against the exact map, pixel by pixel: what is drawn is what the reference shows within
// the broad phase's bound, without cracks; the level cap is reported; culling changes nothing.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../raster/raster_driver.h"
#include "refraction/passes/vertex_programs.h"
#include "refraction/passes/water_region.h"
#include "oracle_scene.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

constexpr int kWidth = 320, kHeight = 200;

// A level grid of columns x rows quads in [-x, x] x [-z, z] at y, seen from both sides.
struct Sheet {
  double x, y, z;
  int columns, rows;
};

WaterBody still_water(double size, float ior) {
  WaterBody w;
  const float s = static_cast<float>(size);
  w.outline = {{-s, 0, s}, {s, 0, s}, {s, 0, -s}, {-s, 0, s}, {s, 0, -s}, {-s, 0, -s}};
  w.depth_m = 100;
  w.ior = ior;
  return w;
}

RenderScene scene_of(const std::vector<Sheet>& sheets, float ior) {
  RenderScene scene;
  scene.materials.materials.resize(1);
  scene.materials.materials[0].double_sided = true;
  for (const Sheet& s : sheets) {
    std::vector<Vec3f> p;
    std::vector<std::uint32_t> indices;
    for (int j = 0; j <= s.rows; ++j)
      for (int i = 0; i <= s.columns; ++i)
        p.push_back({static_cast<float>(s.x * (2.0 * i / s.columns - 1)), static_cast<float>(s.y),
                     static_cast<float>(s.z * (2.0 * j / s.rows - 1))});
    for (int j = 0; j < s.rows; ++j)
      for (int i = 0; i < s.columns; ++i) {
        const std::uint32_t a = static_cast<std::uint32_t>(j * (s.columns + 1) + i), b = a + 1,
                            c = a + static_cast<std::uint32_t>(s.columns) + 1, d = c + 1;
        indices.insert(indices.end(), {a, c, d, a, d, b});
      }
    const std::vector<Vec3f> normals(p.size(), Vec3f{0, 1, 0});
    MeshView mesh;
    mesh.positions_world = p.data(), mesh.normals_world = normals.data(), mesh.indices = indices.data();
    mesh.vertex_count = static_cast<std::uint32_t>(p.size()),
    mesh.index_count = static_cast<std::uint32_t>(indices.size());
    append_mesh(scene.geometry, mesh);
  }
  scene.waters.push_back(still_water(1000, ior));
  return scene;
}

WaterOptics optics_of(const WaterBody& body, const View& view) {
  WaterOptics optics;
  optics.water.body = &body;
  optics.exact = optics.map = make_broad_phase(body, view);
  return optics;
}

// The refracted pass as the frame sets it up, over the whole frame.
//   optics  outlives the pass
WaterPass pass_of(const WaterOptics& optics, const View& view) {
  WaterPass w;
  w.optics = &optics;
  w.clip_plane = {optics.map.far_normal, 0.02f - dot(optics.map.far_normal, optics.map.plane_origin)};
  w.pass = whole_frame(view.width_px, view.height_px, view.centre_px, 64);
  w.frustum = make_frustum(view, 0, 0, view.width_px - 1, view.height_px - 1);
  return w;
}

// The same program with the culling of meshlets off.
template <class Program>
struct Unculled : Program {
  explicit Unculled(const Program& program) : Program(program) {}
  bool meshlet_outside(const Meshlet&) const { return false; }
};

template <class Program>
VisibilityBuffer draw(const RenderScene& scene, const Program& program, const PassSettings& pass,
                      std::uint64_t& capped) {
  const std::vector<WorkItemBins> work_items =
      bin_geometry(scene.geometry, draw_states(scene.materials.materials), program, pass, 4);
  capped = 0;
  for (const WorkItemBins& work_item : work_items) capped += work_item.subdivision_capped;
  VisibilityBuffer out;
  draw_tiles(work_items, pass, KeepAll{}, out);
  return out;
}

// Culling changes no pixel. (Off the frame, triangles that culling spares may reach the level cap.)
template <class Program>
void check_culling(const RenderScene& scene, const Program& program, const PassSettings& pass) {
  const Unculled<Program> unculled(program);
  std::uint64_t capped = 0;
  const VisibilityBuffer culled = draw(scene, program, pass, capped), all = draw(scene, unculled, pass, capped);
  long different = 0, drawn = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const std::size_t slot = culled.grid.slot(x, y);
      different += culled.id[slot] != all.id[slot] || culled.depth[slot] != all.depth[slot];
      drawn += all.id[slot] != kNoId;
    }
  CHECK(drawn > 100);
  CHECK(different == 0);
}

struct Outcome {
  long inside = 0, cracks = 0, strays = 0, beyond = 0;
  double worst_px = 0;  // from the pixel's centre to where the reference shows what is drawn there
};

// Within which distance of the pixel does the reference show triangle `id`? 1 where not within half a pixel.
double distance_to(const RefractionOracle& oracle, const Camera& camera, int x, int y, std::uint32_t id) {
  for (const double r : {0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5})
    for (int k = 0; k < (r == 0.0 ? 1 : 48); ++k) {
      const double angle = 6.283185307179586 * k / 48;
      if (oracle.trace(camera, kWidth, kHeight, x + 0.5 + r * std::cos(angle), y + 0.5 + r * std::sin(angle)).hit_id ==
          id)
        return r;
    }
  return 1;
}

// Every pixel, or every `step`-th each way.
Outcome compare(const RenderScene& scene, const Camera& camera, const VisibilityBuffer& drawn, int step) {
  const RefractionOracle oracle(scene, true);
  Outcome o;
  for (int y = 0; y < kHeight; y += step)
    for (int x = 0; x < kWidth; x += step) {
      const OraclePixel truth = oracle.trace(camera, kWidth, kHeight, x + 0.5, y + 0.5);
      if (!truth.water || truth.hit_kind == HitKind::kMirror) continue;
      const std::int32_t id = drawn.id[drawn.grid.slot(x, y)];
      const std::uint32_t shown = id == kNoId ? kNothing : static_cast<std::uint32_t>(id);
      o.inside += truth.hit_id != kNothing;
      if (shown == truth.hit_id) continue;
      // Something next to where nothing is: within the bound of the outline or a crack, or a stray.
      const double r = distance_to(oracle, camera, x, y, shown);
      o.worst_px = std::max(o.worst_px, r);
      if (r > 0.25) ++(shown == kNothing ? o.cracks : (truth.hit_id == kNothing ? o.strays : o.beyond));
    }
  return o;
}

void check(const std::string& name, const RenderScene& scene, const Camera& camera, int step) {
  const View view = make_view(camera, kWidth, kHeight, {0, 0});
  const WaterOptics optics = optics_of(scene.waters[0], view);
  const WaterPass water = pass_of(optics, view);
  std::uint64_t capped = 0;
  const VisibilityBuffer drawn = draw(scene, RefractedProgram(water, view), water.pass, capped);
  const Outcome o = compare(scene, camera, drawn, step);
  INFO(name);
  CAPTURE(o.inside, o.worst_px, capped);
  CHECK(o.inside > 500 / (step * step));
  CHECK(o.cracks == 0);
  CHECK(o.strays == 0);
  CHECK(o.beyond == 0);
  CHECK(capped == 0);

  check_culling(scene, RefractedProgram(water, view), water.pass);
}

}  // namespace

TEST_CASE("subdivision: a single large quad under water shows where the reference shows it, without cracks") {
  for (const float ior : {1.333f, 1.7f, 0.8f}) {
    const RenderScene scene = scene_of({{6, -2, 5, 1, 1}}, ior);
    check("from above", scene, camera_at({1, 3, 4}, {0, -2, 0}, 1.0), 1);
    if (ior > 1) check("grazing", scene, camera_at({2, 0.4f, 9}, {0, -1, 0}, 0.7), 1);  // below 1 it is a mirror
    check("straight down", scene, camera_at({0.3f, 2, 0.2f}, {0.2f, -2, 0.1f}, 1.4), 1);
    if (ior > 1) check("close to the surface", scene, camera_at({1, 0.03f, 4}, {0, -0.6f, 0}, 1.0), 1);
  }
}

TEST_CASE("subdivision: a coarse and a fine basin floor both show each cell where the reference shows it") {
  // As many vertices as Liu et al. (2020, Fig. 12) give their two basins: 98 and about 1093.
  for (const Sheet& floor : {Sheet{6, -2.2, 4, 13, 6}, Sheet{6, -2.2, 4, 39, 26}}) {
    const RenderScene scene = scene_of({floor}, 1.333f);
    const int step = floor.columns > 20 ? 3 : 1;
    check("from above", scene, camera_at({1, 3, 7}, {0, -2, 0}, 1.0), step);
    check("grazing", scene, camera_at({2, 0.5f, 9}, {0, -1, 0}, 0.7), step);
  }
}

TEST_CASE("subdivision: a ceiling seen from under water through Snell's window shows where the reference shows it") {
  const RenderScene scene = scene_of({{5, 1.5, 5, 4, 4}}, 1.333f);
  check("up", scene, camera_at({0.3f, -1.5f, 0.2f}, {0.31f, 1, 0.2f}, 1.6), 1);
  check("aslant", scene, camera_at({2, -0.8f, 2}, {0, 0.6f, 0}, 1.2), 1);
}

TEST_CASE("subdivision: an orthographic view needs none and is exact") {
  const RenderScene scene = scene_of({{3, -2, 2, 5, 5}}, 1.333f);
  Camera camera = camera_at({2, 4, 3}, {0, -2, 0}, 1.0);
  camera.orthographic = true, camera.xmag_m = 4, camera.ymag_m = 2.5f, camera.far_m = 50;
  check("orthographic", scene, camera, 1);
}

TEST_CASE("culling: meshlets that a pass leaves out would not have shown, direct, refracted and reflected") {
  for (const char* name : {"box", "pool"}) {
    const RenderScene scene = built_in(name, 2000);
    for (const PlacedCamera& placed : scene.cameras) {
      INFO(name << ", " << placed.name);
      const View view = make_view(placed.camera, kWidth, kHeight, {0, 0});
      const WaterOptics optics = optics_of(scene.waters[0], view);
      const WaterPass water = pass_of(optics, view);
      check_culling(scene, DirectProgram{view, water.frustum}, water.pass);
      check_culling(scene, RefractedProgram(water, view), water.pass);
      if (!optics.exact.eye_below) continue;
      const WaterPass reflected = reflected_pass(water);
      check_culling(scene, ReflectedProgram(reflected, view), reflected.pass);
    }
  }
}

TEST_CASE("subdivision: a triangle that reaches the level cap is reported") {
  // A floor of 40 km half a metre under the water, seen from close to it; and from high above.
  const RenderScene scene = scene_of({{20000, -0.5, 20000, 1, 1}}, 1.333f);
  FrameSettings settings;
  settings.width_px = 64, settings.height_px = 40, settings.threads = 1;
  settings.isa = supported_isas().front();
  Renderer renderer(scene, settings);
  Frame frame;
  renderer.render(camera_at({0, 0.1f, 0}, {0, -0.5f, 0.6f}, 1.2), 0, frame);
  CHECK(frame.subdivision_capped > 0);
  renderer.render(camera_at({0, 5000.0f, 0}, {0, -0.5f, 0.3f}, 1.2), 0, frame);
  CHECK(frame.subdivision_capped == 0);
}
