// shade_hits and alpha_bits on a triangle by itself: under water against double precision, and what shadow rays get.
#include "shading/shade_hits.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "../core/isa_case.h"
#include "shading/shadow/shadow_map.h"

using namespace shoal;

namespace {

// One triangle in the plane y = -2, under a sun from straight above, seen from the plane y = 0 downwards.
struct Pit {
  Geometry geometry;
  std::vector<Material> materials{1};
  std::vector<DrawState> states;
  std::vector<Texture> textures;
  Lighting lighting;
  ShadingView view;
  Ray<WideF> ray;
  RayDifferential<WideF> differential{};

  Pit() {
    const Vec3f positions[3] = {{-10, -2, 10}, {10, -2, 10}, {0, -2, -10}};
    const Vec3f normals[3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
    const Vec2f uvs[3] = {{0, 0}, {1, 0}, {0.5f, 1}};
    const std::uint32_t indices[3] = {0, 1, 2};
    MeshView mesh;
    mesh.positions_world = positions, mesh.normals_world = normals, mesh.uvs = uvs, mesh.indices = indices;
    mesh.vertex_count = mesh.index_count = 3;
    append_mesh(geometry, mesh);
    materials[0].base_color = {0.5f, 0.25f, 1, 1};
    materials[0].metallic = 0;
    lighting.directional.push_back({{0, -1, 0}, {3, 3, 3}});
    connect();
    const WideF zero(0.0f), x = to_float(lane_index()) * WideF(0.125f) - WideF(0.95f);
    ray = {{x, zero, zero}, {zero, WideF(-0.5f), zero}};
  }
  void connect() {
    states = draw_states(materials);
    view.geometry = view_of(geometry, states.data());
    view.materials = materials.data(), view.textures = textures.data(), view.lighting = &lighting;
  }
  ShadedLanes shade(const LightMedium* medium, std::uint32_t lanes = 0xFFFFu) const {
    ShadedLanes out;
    shade_hits(view, ray, differential, WideI(0), mask_from_bits(lanes), medium, out);
    return out;
  }
};

LightMedium medium_of(float depth_of_plane) {
  LightMedium m;
  m.plane_origin = {3, depth_of_plane, -5};
  m.absorption_per_m = {0.35f, 0.07f, 0.03f};
  m.path_per_depth = 1.25f;
  m.transmitted = 0.75f;
  return m;
}

// Records what it is given and blocks the odd lanes.
struct Recorder {
  mutable ShadowQuery query{};
  mutable const SunBend* bend = nullptr;
  mutable std::uint32_t lanes = 0;
  mutable int calls = 0;
};
std::uint32_t block_odd(const void* context, const ShadowQuery& query, const SunBend* bend, std::uint32_t lanes) {
  const Recorder& r = *static_cast<const Recorder*>(context);
  r.query = query, r.bend = bend, r.lanes = lanes, ++r.calls;
  return lanes & 0xAAAAu;
}

}  // namespace

SHOAL_ISA_CASE(water_dims, "shade_hits: water dims the light of points below its plane, and no others") {
  const Pit pit;
  const ShadedLanes air = pit.shade(nullptr);
  CHECK(extract(air.t, 7) == Approx(4));
  CHECK(extract(air.surface.position_world.y, 7) == Approx(-2));
  CHECK(extract(air.surface.base_color.y, 7) == 0.25f);
  CHECK(extract(air.radiance.x, 7) > 0.1f);

  const LightMedium below = medium_of(-0.5f);  // 1.5 m of water above the points
  const ShadedLanes wet = pit.shade(&below);
  const double absorption[3] = {0.35, 0.07, 0.03};
  for (int lane = 0; lane < 16; ++lane) {
    const float dry[3] = {extract(air.radiance.x, lane), extract(air.radiance.y, lane), extract(air.radiance.z, lane)};
    const float dim[3] = {extract(wet.radiance.x, lane), extract(wet.radiance.y, lane), extract(wet.radiance.z, lane)};
    for (int c = 0; c < 3; ++c)
      CHECK(static_cast<double>(dim[c]) ==
            Approx(static_cast<double>(dry[c]) * 0.75 * std::exp(-absorption[c] * 1.5 * 1.25)).epsilon(2e-6));
  }

  const LightMedium above = medium_of(-3.0f);  // the points are a metre above the water
  const ShadedLanes dry = pit.shade(&above);
  for (int lane = 0; lane < 16; ++lane) CHECK(extract(dry.radiance.y, lane) == extract(air.radiance.y, lane));
}

SHOAL_ISA_CASE(shadow_rays,
               "shade_hits: shadow rays get the points, the facet and the water's bend, and take the sun's light") {
  Pit pit;
  Recorder recorder;
  pit.view.shadow_rays = {&block_odd, &recorder};
  LightMedium medium = medium_of(-0.5f);
  const ShadedLanes out = pit.shade(&medium, 0x0FF0u);
  REQUIRE(recorder.calls == 1);
  CHECK(recorder.lanes == 0x0FF0u);
  CHECK(recorder.bend == &medium.bend);
  for (int lane = 4; lane < 12; ++lane) {
    CHECK(recorder.query.position_world[0][lane] == extract(out.surface.position_world.x, lane));
    CHECK(recorder.query.position_world[1][lane] == extract(out.surface.position_world.y, lane));
    CHECK(std::fabs(recorder.query.facet_world[1][lane]) == Approx(1));
    CHECK((extract(out.radiance.x, lane) == 0.0f) == (lane % 2 == 1));
  }
  pit.shade(nullptr);
  CHECK(recorder.bend == nullptr);

  // Nothing is asked where the sun is behind the surface, or where there is none.
  pit.lighting.directional[0].direction_world = {0, 1, 0};
  pit.shade(nullptr);
  pit.lighting.directional.clear();
  pit.shade(nullptr);
  CHECK(recorder.calls == 2);
}

SHOAL_ISA_CASE(materials_apart,
               "shade_hits: lanes of different materials are shaded as if alone; an unlit one is its colour") {
  Pit pit;
  pit.materials.resize(2);
  pit.materials[1].base_color = {1, 0.5f, 0.125f, 1};
  pit.materials[1].unlit = true;
  const Vec3f positions[3] = {{-10, -3, 10}, {10, -3, 10}, {0, -3, -10}}, up[3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
  const std::uint32_t indices[3] = {0, 1, 2};
  MeshView mesh;
  mesh.positions_world = positions, mesh.normals_world = up, mesh.indices = indices;
  mesh.vertex_count = mesh.index_count = 3, mesh.material = 1;
  append_mesh(pit.geometry, mesh);
  pit.connect();
  const ShadedLanes first = pit.shade(nullptr);
  ShadedLanes both;
  const WideI id = select((lane_index() & WideI(3)) == WideI(0), WideI(1), WideI(0));
  shade_hits(pit.view, pit.ray, pit.differential, id, mask_from_bits(0xFFFFu), nullptr, both);
  for (int lane = 0; lane < 16; ++lane) {
    const bool second = lane % 4 == 0;
    CHECK(extract(both.surface.position_world.y, lane) == Approx(second ? -3 : -2));
    CHECK(extract(both.radiance.y, lane) == (second ? 0.5f : extract(first.radiance.y, lane)));
  }
}

SHOAL_ISA_CASE(alpha_cut_out, "alpha_bits: covered pixels whose alpha reaches the cutoff") {
  Pit pit;
  // Texels left to right: alpha 0 and 1, nearest.
  const std::uint8_t texels[8] = {255, 255, 255, 0, 255, 255, 255, 255};
  pit.textures.push_back(make_texture_rgba8(2, 1, texels, true));
  pit.materials[0].alpha_mode = AlphaMode::kMask;
  pit.materials[0].base_color_texture = 0;
  pit.materials[0].base_color_sampler.magnify = Filter::kNearest;
  pit.connect();
  CHECK(pit.states[0].alpha_tested);
  // u = 0.5 lies at x = 0: the lanes from 8 on are to its right.
  CHECK(alpha_bits(pit.view, pit.ray, pit.differential, 0, 0xFFFFu) == 0xFF00u);
  CHECK(alpha_bits(pit.view, pit.ray, pit.differential, 0, 0x0F3Fu) == 0x0F00u);
}
