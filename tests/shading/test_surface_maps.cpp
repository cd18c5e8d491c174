// A material's textures on a pixel: tangent frames against double, what must change nothing, what each channel does.
#include "shading/surface_maps.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "shading/light.h"

using namespace shoal;

namespace {

struct Random {
  std::mt19937 engine{815};
  double between(double a, double b) { return a + (b - a) * (static_cast<double>(engine()) / 4294967296.0); }
  Vec3d direction() {
    for (;;) {
      const Vec3d v{between(-1, 1), between(-1, 1), between(-1, 1)};
      const double l2 = dot(v, v);
      if (l2 > 0.01 && l2 < 1) return v * (1 / std::sqrt(l2));
    }
  }
};
Vec3d unit(Vec3d v) { return v * (1 / std::sqrt(dot(v, v))); }
Vec3f narrow(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
Vec3d widen(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3<WideF> wide(Vec3f v) { return broadcast<WideF>(v); }
Vec3f lane(const Vec3<WideF>& v, int i) { return {extract(v.x, i), extract(v.y, i), extract(v.z, i)}; }

Texture one_texel(std::uint8_t r, std::uint8_t g, std::uint8_t b, bool srgb = false) {
  const std::uint8_t texel[4] = {r, g, b, 255};
  return make_texture_rgba8(1, 1, texel, srgb);
}
Texture one_texel(float r, float g, float b) {
  const float texel[4] = {r, g, b, 1};
  return make_texture_float(1, 1, texel);
}

PixelAttributes<WideF> attributes() {
  PixelAttributes<WideF> a;
  const WideF zero(0.0f), one(1.0f);
  a.position_world = a.tangent_world = {zero, zero, zero};
  a.normal_world = {zero, one, zero};
  a.tangent_world.x = one;
  a.handedness = one;
  a.t = one;
  a.uv = a.duv_dx = a.duv_dy = a.uv1 = a.duv1_dx = a.duv1_dy = {zero, zero};
  a.color = {one, one, one, one};
  a.material = WideI(0);
  return a;
}

struct Fixture {
  std::vector<Texture> textures;
  Material material;
  Vec4f tangent{1, 0, 0, 1};
  Vec2f uv1{0, 0};
  GeometryView view{};
  PixelAttributes<WideF> a = attributes();
  Vec3<WideF> eye = wide({0, 1, 0});

  Fixture() { view.tangents = &tangent, view.uvs1 = &uv1; }
  SurfaceSample<WideF> run() {
    const WideM all = mask_from_bits(0xFFFFu);
    SurfaceSample<WideF> s = make_surface<WideF>(material, textures.data(), a.position_world, a.normal_world, a.uv,
                                                 a.duv_dx, a.duv_dy, a.color, eye, all);
    apply_maps(view, material, textures.data(), a, eye, all, s);
    return s;
  }
  std::int32_t add(Texture t) {
    textures.push_back(std::move(t));
    return static_cast<std::int32_t>(textures.size() - 1);
  }
};

}  // namespace

TEST_CASE("a mapped normal is the tangent frame's, against double") {
  Random random;
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f n = narrow(random.direction());
    const Vec3d t0 = random.direction();
    if (std::fabs(dot(t0, widen(n))) > 0.9) continue;
    const Vec3f t = narrow(t0 * random.between(0.1, 2));
    const float h = i % 2 ? 1.0f : -1.0f, scale = static_cast<float>(random.between(0.1, 2));
    const Vec4f texel{static_cast<float>(random.between(0, 1)), static_cast<float>(random.between(0, 1)),
                      static_cast<float>(random.between(0.6, 1)), 1};
    const Vec3f got = mapped_normal<float>(n, t, h, texel, scale);
    const Vec3d nd = widen(n), td = unit(widen(t));
    const Vec3d b = cross(nd, td) * double{h};
    const Vec3d want =
        unit(td * ((2.0 * texel.x - 1) * scale) + b * ((2.0 * texel.y - 1) * scale) + nd * (2.0 * texel.z - 1));
    const Vec3d off = widen(got) - want;
    worst = std::max(worst, std::sqrt(dot(off, off)));
  }
  CAPTURE(worst);
  CHECK(worst < 1e-6);
}

TEST_CASE("a flat normal map and one that is no direction change nothing; x is along u, y up") {
  Fixture f;
  f.material.normal.texture = f.add(one_texel(0.5f, 0.5f, 1.0f));
  CHECK(lane(f.run().normal_world, 3).y == 1.0f);
  f.textures[0] = one_texel(0.5f, 0.5f, 0.5f);
  CHECK(lane(f.run().normal_world, 3).y == 1.0f);
  f.textures[0] = one_texel(std::uint8_t{128}, 128, 255);
  CHECK(lane(f.run().normal_world, 3).y == Approx(1).margin(4e-5));
  f.textures[0] = one_texel(1.0f, 0.5f, 0.5f);
  CHECK(lane(f.run().normal_world, 0).x == Approx(1).margin(1e-6));
  f.textures[0] = one_texel(0.5f, 1.0f, 0.5f);
  CHECK(lane(f.run().normal_world, 0).z == Approx(-1).margin(1e-6));  // cross(+y, +x)
  f.a.handedness = WideF(-1.0f);
  CHECK(lane(f.run().normal_world, 0).z == Approx(1).margin(1e-6));
  // Steeper by the scale.
  f.textures[0] = one_texel(0.75f, 0.5f, 1.0f);
  f.material.normal_scale = 2;
  CHECK(lane(f.run().normal_world, 0).x == Approx(std::sqrt(0.5)).epsilon(1e-6));
}

TEST_CASE("channels: roughness G, metallic B, occlusion R, emission RGB decoded, ior") {
  Fixture f;
  f.material.metallic = 0.5f, f.material.roughness = 0.8f;
  f.material.emissive = {2, 4, 1};
  f.material.metallic_roughness.texture = f.add(one_texel(std::uint8_t{9}, 51, 204));
  f.material.occlusion.texture = f.add(one_texel(std::uint8_t{102}, 7, 8));
  f.material.occlusion_strength = 0.5f;
  f.material.emission.texture = f.add(one_texel(188, 255, 0, true));
  f.material.ior = 2;
  const SurfaceSample<WideF> s = f.run();
  CHECK(extract(s.roughness, 5) == Approx(0.8 * 0.2).epsilon(1e-4));
  CHECK(extract(s.metallic, 5) == Approx(0.5 * 0.8).epsilon(1e-4));
  CHECK(extract(s.occlusion, 5) == Approx(1 - 0.5 * (1 - 0.4)).epsilon(1e-4));
  CHECK(extract(s.emissive.x, 5) == Approx(2 * std::pow((188 / 255.0 + 0.055) / 1.055, 2.4)).epsilon(1e-4));
  CHECK(extract(s.emissive.y, 5) == 4.0f);
  CHECK(extract(s.emissive.z, 5) == 0.0f);
  CHECK(extract(s.f0_dielectric, 5) == Approx(1.0 / 9).epsilon(1e-6));
  CHECK(dielectric_f0(1.5f) == 0.04f);
  CHECK(dielectric_f0(0.0f) == 1.0f);
  CHECK(dielectric_f0(1.0f) == 0.0f);
}

TEST_CASE("a map reads its own set of coordinates, turned and scaled as KHR_texture_transform says") {
  Fixture f;
  const std::uint8_t texels[16] = {10, 0, 0, 255, 20, 0, 0, 255, 30, 0, 0, 255, 40, 0, 0, 255};
  f.material.occlusion.texture = f.add(make_texture_rgba8(2, 2, texels, false));
  f.material.occlusion.sampler.magnify = f.material.occlusion.sampler.minify = Filter::kNearest;
  f.a.uv = broadcast<WideF>(Vec2f{0.75f, 0.25f});
  f.a.uv1 = broadcast<WideF>(Vec2f{0.25f, 0.75f});
  CHECK(extract(f.run().occlusion, 0) == Approx(20 / 255.0).epsilon(1e-3));
  f.material.occlusion.uv.set = 1;
  CHECK(extract(f.run().occlusion, 0) == Approx(30 / 255.0).epsilon(1e-3));
  // A quarter turn takes (u, v) to (v, -u): (0.75, -0.25), then 0 on u and 1 on v is added.
  f.material.occlusion.uv = make_uv_map(1, {0, 1}, 1.57079632679f, {1, 1});
  CHECK(extract(f.run().occlusion, 0) == Approx(40 / 255.0).epsilon(1e-3));
  const UvPoint<float> p =
      transform_uv<float>(make_uv_map(0, {0.5f, 2}, 1.57079632679f, {2, 4}), {{1, 1}, {1, 0}, {0, 1}});
  CHECK(p.uv.x == Approx(4.5));
  CHECK(p.uv.y == Approx(0).margin(1e-6));
  CHECK(p.duv_dx.y == Approx(-2));
  CHECK(p.duv_dy.x == Approx(4));
}

TEST_CASE("seen from behind, the whole tangent frame turns: a double-sided bump is a dent") {
  Geometry g;
  const Vec3f positions[3] = {{-1, 0, 1}, {3, 0, 1}, {-1, 0, -3}};
  const Vec3f normals[3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
  const Vec2f uvs[3] = {{0, 1}, {2, 1}, {0, -1}}, uvs1[3] = {{0, 0}, {4, 0}, {0, 8}};
  const Vec4f tangents[3] = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
  const std::uint32_t indices[3] = {0, 1, 2};
  MeshView mesh;
  mesh.positions_world = positions, mesh.normals_world = normals, mesh.uvs = uvs, mesh.uvs1 = uvs1;
  mesh.tangents_world = tangents, mesh.indices = indices, mesh.vertex_count = 3, mesh.index_count = 3;
  append_mesh(g, mesh);
  Material m;
  m.double_sided = true;
  const Texture texture = one_texel(0.75f, 0.625f, 1.0f);
  const DrawState state{.double_sided = true};
  m.normal.texture = 0;
  for (const float side : {1.0f, -1.0f}) {
    const Ray<WideF> ray{wide({0, side, 0}), wide({0, -side, 0})};
    RayDifferential<WideF> differential{};
    const WideM all = mask_from_bits(0xFFFFu);
    PixelAttributes<WideF> a;
    const GeometryView view = view_of(g, &state);
    resolve_attributes(view, ray, differential, WideI(0), all, a);
    CHECK(extract(a.uv1.x, 7) == Approx(1));
    CHECK(extract(a.uv1.y, 7) == Approx(2));
    SurfaceSample<WideF> s = make_surface<WideF>(m, &texture, a.position_world, a.normal_world, a.uv, a.duv_dx,
                                                 a.duv_dy, a.color, wide({0, side, 0}), all);
    apply_maps(view, m, &texture, a, wide({0, side, 0}), all, s);
    const Vec3f n = lane(s.normal_world, 7);
    const double length = std::sqrt(0.25 + 0.0625 + 1);
    CHECK(n.x == Approx(side * 0.5 / length).epsilon(1e-5));
    CHECK(n.y == Approx(side / length).epsilon(1e-5));
    CHECK(n.z == Approx(side * -0.25 / length).epsilon(1e-5));
  }
}

TEST_CASE("a white furnace with bumps: ambient light alone, dimmed by occlusion; direct light is not") {
  Lighting furnace;
  furnace.ambient_up = furnace.ambient_down = furnace.background.color = {1, 1, 1};
  Random random;
  for (int i = 0; i < 500; ++i) {
    SurfaceSample<float> s{};
    s.base_color = {1, 1, 1};
    s.roughness = static_cast<float>(random.between(0, 1));
    const Vec4f texel{static_cast<float>(random.between(0.2, 0.8)), static_cast<float>(random.between(0.2, 0.8)), 1, 1};
    s.normal_world = mapped_normal<float>({0, 1, 0}, {1, 0, 0}, 1, texel, 1);
    const Vec3f v = narrow(unit({random.between(-1, 1), random.between(0.3, 1), random.between(-1, 1)}));
    const float full = shade<float>(s, false, v, furnace, {1, 1, 1}).x;
    CHECK(full <= 1.01f);
    CHECK(full > 0.9f);
    s.occlusion = 0.25f;
    CHECK(shade<float>(s, false, v, furnace, {1, 1, 1}).x == full * 0.25f);
  }
  Lighting sun;
  sun.directional.push_back({{0, -1, 0}, {3, 3, 3}});
  SurfaceSample<float> s{};
  s.normal_world = {0, 1, 0}, s.base_color = {0.5f, 0.5f, 0.5f}, s.roughness = 0.5f;
  const float lit = shade<float>(s, false, {0, 1, 0}, sun, {1, 1, 1}).x;
  s.occlusion = 0;
  CHECK(shade<float>(s, false, {0, 1, 0}, sun, {1, 1, 1}).x == lit);
  CHECK(lit > 0.1f);
}
