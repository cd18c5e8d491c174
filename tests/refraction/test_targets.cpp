// Stages by themselves: a test fills their inputs and reads the named targets that they write.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>

#include "oracle_scene.h"
#include "raster/geometry_view.h"
#include "refraction/methods/kernels.h"
#include "refraction/passes/water_region.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

constexpr int kWidth = 70, kHeight = 37;

// One red triangle in the plane z = -4, unlit, and one camera that looks along -z.
struct OneTriangle {
  Geometry geometry;
  std::vector<Material> materials = std::vector<Material>(1);
  std::vector<DrawState> states;
  Lighting lighting;
  SceneView scene;
  ViewState view;
  FrameGrids grids = make_frame_grids(kWidth, kHeight, 64, 0);
  Targets targets;
  TargetNeeds needs;

  OneTriangle() {
    const Vec3f corners[3] = {{-30, -15, -4}, {30, -15, -4}, {0, 30, -4}}, normal{0, 0, 1};
    const Vec3f normals[3] = {normal, normal, normal};
    const std::uint32_t indices[3] = {0, 1, 2};
    MeshView mesh;
    mesh.positions_world = corners, mesh.normals_world = normals, mesh.indices = indices;
    mesh.vertex_count = mesh.index_count = 3;
    append_mesh(geometry, mesh);
    materials[0].base_color = {0.75f, 0.25f, 0.125f, 1};
    materials[0].metallic = 0.5f, materials[0].roughness = 0.25f;
    materials[0].unlit = true;
    states = draw_states(materials);
    scene.shading.geometry = view_of(geometry, states.data());
    scene.shading.materials = materials.data();
    scene.shading.lighting = &lighting;
    scene.drawables = geometry.drawables;
    scene.triangle_count = 1;
    view.view = make_view(Camera(), kWidth, kHeight, {0, 0});
    view.capture = true;
    needs.capture = needs.linear = needs.water = true;
    allocate(targets, grids, needs);
    clear_captured(targets);
    targets.srgb8.resize(std::size_t{kWidth} * kHeight * 3);
  }
  Vec3d direction(int x, int y) const {
    const View& v = view.view;
    const double dx = x + 0.5 - static_cast<double>(v.centre_px.x), dy = y + 0.5 - static_cast<double>(v.centre_px.y);
    return as_double(v.camera.forward_world) + as_double(v.ray_dx) * dx + as_double(v.ray_dy) * dy;
  }
};

Vec3d at(const PlaneXyz& planes, std::size_t slot) {
  return as_double({planes.x[slot], planes.y[slot], planes.z[slot]});
}

}  // namespace

TEST_CASE("targets: the shade stage resolves a visibility buffer that a test has filled into the G-buffer") {
  for (const Isa isa : supported_isas()) {
    OneTriangle t;
    // A chessboard of the triangle and nothing, whatever the triangle covers: the stage reads ids alone.
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) t.targets.direct.id[t.grids.frame.slot(x, y)] = (x + y) % 2 == 0 ? 0 : kNoId;
    const FrameKernels& kernels = frame_kernels(isa);
    for (std::size_t region = 0; region < t.grids.frame.region_count(); ++region)
      kernels.shade({t.scene, t.view, t.grids, t.targets.direct, t.targets.water_light, nullptr, {}},
                    {t.targets.gbuffer, t.targets.lit, t.targets.srgb8.data()}, region);
    const GBuffer& g = t.targets.gbuffer;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t slot = t.grids.frame.slot(x, y);
        INFO(isa_name(isa) << " pixel " << x << ", " << y);
        if ((x + y) % 2 != 0) {
          REQUIRE(norm_of(at(g.position_world, slot)) + norm_of(at(g.normal_world, slot)) == 0.0);
          REQUIRE(t.targets.lit.alpha[slot] == 0.0f);
          continue;
        }
        const Vec3d d = t.direction(x, y), expected = d * (-4.0 / d.z);
        REQUIRE(norm_of(at(g.position_world, slot) - expected) < 2e-5 * norm_of(expected));
        REQUIRE(at(g.normal_world, slot).z == 1.0);
        REQUIRE(g.base_color.x[slot] == 0.75f);
        REQUIRE(g.base_color.y[slot] == 0.25f);
        REQUIRE(g.metallic[slot] == 0.5f);
        REQUIRE(g.roughness[slot] == 0.25f);
        REQUIRE(t.targets.lit.red[slot] == 0.75f);  // unlit: the colour as it is
      }
  }
}

TEST_CASE("targets: the interface stage follows Snell's law at every water pixel, and writes no other") {
  WaterBody body;
  body.origin = {0, 0, -6};
  body.normal = {0, 0, 1}, body.axis_x = {1, 0, 0}, body.axis_z = {0, -1, 0};
  body.outline = {{-90, -90, -6}, {90, -90, -6}, {0, 90, -6}};
  body.depth_m = 3;
  const PlacedWater placed{&body, nullptr, 0};
  for (const Isa isa : supported_isas()) {
    OneTriangle t;
    t.scene.water = {&placed, 1};
    std::vector<WaterOptics> optics;
    place_water({t.scene.water, t.view.view, [](const WaterBody& b, const View& v) { return make_broad_phase(b, v); },
                 Reflections::kTraced, Reflections::kTraced, false},
                {optics, t.view.eye_in_water});
    REQUIRE(optics.size() == 1);
    REQUIRE(t.view.eye_in_water == -1);
    const auto wet = [](int x, int y) { return (x * 7 + y * 3) % 5 < 2; };
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        t.targets.direct.id[t.grids.frame.slot(x, y)] = wet(x, y) ? kFirstWaterId : kNoId;
    AlignedArray<RegionScratch> scratch(1);
    const FrameKernels& kernels = frame_kernels(isa);
    std::uint64_t pixels = 0;
    for (std::size_t region = 0; region < t.grids.frame.region_count(); ++region) {
      pixels += kernels.count_water(t.targets.direct, 0, region).pixels;
      kernels.find_interface({t.scene, t.view, t.grids.frame, optics[0], t.targets.direct},
                             {scratch[0].interface, t.targets.interface, t.targets.gbuffer, t.targets.hits}, region);
    }
    std::uint64_t expected_pixels = 0;
    const InterfaceTarget& found = t.targets.interface;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t slot = t.grids.frame.slot(x, y);
        INFO(isa_name(isa) << " pixel " << x << ", " << y);
        if (!wet(x, y)) {
          REQUIRE(found.t[slot] == 0.0f);
          REQUIRE(t.targets.hits.kind[slot] == static_cast<std::int32_t>(HitKind::kNoWater));
          continue;
        }
        ++expected_pixels;
        const Vec3d d = t.direction(x, y), i = unit_of(d);
        REQUIRE(std::fabs(static_cast<double>(found.t[slot]) - -6.0 / d.z) < 1e-5);
        // Snell: the tangential part shrinks by the index; mirror: the normal part turns.
        const double n = 1.0 / static_cast<double>(body.ior);
        const Vec3d tangential = Vec3d{i.x, i.y, 0} * n;
        const Vec3d refracted = tangential + Vec3d{0, 0, -std::sqrt(1 - dot(tangential, tangential))};
        REQUIRE(norm_of(at(found.refracted, slot) - refracted) < 2e-6);
        REQUIRE(norm_of(at(found.reflected, slot) - Vec3d{i.x, i.y, -i.z}) < 2e-6);
        REQUIRE(at(found.normal_world, slot).z == 1.0);
        REQUIRE(found.slope_variance[slot] == 0.0f);
        REQUIRE(t.targets.hits.kind[slot] == static_cast<std::int32_t>(HitKind::kSky));
      }
    REQUIRE(pixels == expected_pixels);
  }
}

TEST_CASE("targets: the table allocates what the needs name, on its own grid, and no more") {
  const FrameGrids grids = make_frame_grids(200, 100, 32, kWaveMargin_px);
  for (int bits = 0; bits < 64; ++bits) {
    TargetNeeds needs;
    needs.water = (bits & 1) != 0, needs.lit_layer = (bits & 2) != 0, needs.blended = (bits & 4) != 0;
    needs.capture = (bits & 8) != 0, needs.linear = (bits & 16) != 0;
    needs.behind = (bits & 32) != 0;
    Targets t;
    allocate(t, grids, needs);
    const std::size_t frame = grids.frame.pixel_slots(), layers = grids.layers.grid.pixel_slots();
    REQUIRE(layers > frame);
    CHECK(t.direct.id.size() == frame);
    CHECK(t.refracted.depth.size() == (needs.water ? layers : 0));
    CHECK(t.reflected.id.size() == (needs.water ? layers : 0));
    CHECK(t.layer.radiance.x.size() == (needs.water && needs.lit_layer ? layers : 0));
    CHECK(t.interface.slope_variance.size() == (needs.water && needs.capture ? frame : 0));
    CHECK(t.gbuffer.roughness.size() == (needs.capture ? frame : 0));
    CHECK(t.refracted_behind.id.size() == (needs.water && needs.behind ? layers : 0));
    CHECK(t.reflected_behind.depth.size() == (needs.water && needs.behind ? layers : 0));
    CHECK(t.hits.secondary.size() == (needs.capture ? frame : 0));
    CHECK(t.hits.approximate.size() == (needs.capture ? frame : 0));
    CHECK(t.water_light.radiance.z.size() == (needs.water ? frame : 0));
    CHECK(t.lit.alpha.size() == (needs.linear ? frame : 0));
    CHECK(t.blended_direct.filled.size() == (needs.blended ? grids.frame.block_count() : 0));
    CHECK(t.blended_reflected.filled.size() == (needs.blended && needs.water ? grids.frame.block_count() : 0));
  }
}
