// The sun's shadow map against rays in double, traced by brute force at what pixels show, in the air and through water.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "refraction/renderer.h"
#include "scene/sun_bend.h"
#include "shading/shadow/shadow_map.h"

using namespace shoal;

namespace {

Vec3d to_double(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3d unit(Vec3d v) { return v * (1.0 / std::sqrt(dot(v, v))); }

// Columns right, up, back; at a place.
Mat4 frame(Vec3d x, Vec3d y, Vec3d z, Vec3d at) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return from_rows({f(x.x), f(y.x), f(z.x), f(at.x)}, {f(x.y), f(y.y), f(z.y), f(at.y)},
                   {f(x.z), f(y.z), f(z.z), f(at.z)});
}
// Looks or shines from `at` towards `to`.
Mat4 aimed(Vec3d at, Vec3d to) {
  const Vec3d back = unit(at - to), right = unit(cross(Vec3d{0, 1, 0}, back));
  return frame(right, cross(back, right), back, at);
}
Mat4 turned(double degrees, Vec3d scale, Vec3d at) {
  const double a = degrees * 3.14159265358979 / 180, c = std::cos(a), s = std::sin(a);
  return frame(Vec3d{c, s * 0.6, s * 0.8} * scale.x, Vec3d{-s, c * 0.6, c * 0.8} * scale.y,
               Vec3d{0, -0.8, 0.6} * scale.z, at);
}

// A box from -1 to 1, each side with corners of its own.
Mesh box_mesh() {
  MeshPrimitive p;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const auto base = static_cast<std::uint32_t>(p.positions.size());
      for (int corner = 0; corner < 4; ++corner) {
        const float u = corner == 1 || corner == 2 ? 1.0f : -1.0f, v = corner >= 2 ? 1.0f : -1.0f;
        const std::array<float, 3> local = {side, u * side, v};
        const auto place = [&](std::array<float, 3> c) {
          return Vec3f{c[(3 - axis) % 3], c[(4 - axis) % 3], c[(5 - axis) % 3]};
        };
        p.positions.push_back(place(local));
        p.normals.push_back(place({side, 0, 0}));
      }
      for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(base + i);
    }
  }
  return {"box", {p}};
}

const Vec3d kSun = unit({-0.5, -0.8, 0.33});  // the way that its light travels

void add_box(Scene& scene, const Mat4& place) {
  Node node;
  node.mesh = 0;
  node.world_from_local = place;
  scene.nodes.push_back(node);
}

// Boxes over, in and under two metres of water, and some that stand through its surface.
RenderScene make_scene() {
  Scene scene;
  scene.name = "boxes";
  scene.materials.materials.resize(1);
  scene.meshes.push_back(box_mesh());
  add_box(scene, frame({9, 0, 0}, {0, 0.25, 0}, {0, 0, 9}, {0, -2.25, 0}));
  for (int i = 0; i < 8; ++i) {
    const double x = -5 + 1.5 * i, z = i % 2 ? 2.4 : -2.1, y = -1.5 + 0.55 * i;
    add_box(scene, turned(37 * i, {0.7, 0.2 + 0.1 * i, 0.9}, {x, y, z}));
  }
  Node sun, water;
  sun.light = 0;
  sun.world_from_local = aimed({0, 0, 0}, kSun);
  scene.lights.push_back({{1, 0.9f, 0.8f}, 3});
  scene.nodes.push_back(sun);
  water.water = 0;
  WaterSpec spec;
  spec.has_size = true;
  spec.size_x = spec.size_z = 16;
  spec.has_depth = true;
  spec.depth = 2;
  scene.waters.push_back(spec);
  scene.nodes.push_back(water);
  scene.has_background = true;
  scene.background.color = {0.3f, 0.4f, 0.5f};
  scene.cameras.resize(1);
  for (const Vec3d eye : {Vec3d{5, 6, 9}, Vec3d{-6, -1.2, 6}, Vec3d{-3, 2, -9}}) {
    Node camera;
    camera.camera = 0;
    camera.world_from_local = aimed(eye, {0, -0.6, 0});
    scene.nodes.push_back(camera);
  }
  return build_render_scene(scene);
}

FrameSettings settings_of(Shadows shadows) {
  FrameSettings s;
  s.width_px = 200;
  s.height_px = 120;
  s.isa = supported_isas().front();
  s.threads = 2;
  s.reflections = Reflections::kEnvironment;  // a shadow must not be seen twice in a pixel
  s.shadows = shadows;
  s.shadow_map_px = 2048;
  s.reflections = Reflections::kEnvironment;  // a pixel's light is that of one point
  s.keep_linear = true;
  s.aovs = 1u << int(Aov::kPosition) | 1u << int(Aov::kIdTriangle) | 1u << int(Aov::kHitKind) |
           1u << int(Aov::kHitPosition) | 1u << int(Aov::kHitId);
  return s;
}

Frame render(const RenderScene& scene, const FrameSettings& settings, std::size_t camera) {
  Frame frame;
  Renderer(scene, settings).render(scene.cameras[camera].camera, 0, frame);
  return frame;
}

const AovImage& aov(const Frame& frame, Aov which) {
  return *std::find_if(frame.aovs.begin(), frame.aovs.end(), [&](const AovImage& a) { return a.aov == which; });
}

struct Corners {
  Vec3d a, b, c;
};
Corners corners(const RenderScene& scene, std::size_t id) {
  const Geometry::TriangleRecord& t = scene.geometry.triangles[id];
  const auto at = [&](int k) { return to_double(scene.geometry.vertices[t.vertex[k]].position_world); };
  return {at(0), at(1), at(2)};
}

// Is a triangle other than `own` between `from` and from + way * reach? By signed volumes.
bool blocked(const RenderScene& scene, Vec3d from, Vec3d way, double reach, std::size_t own) {
  for (std::size_t i = 0; i < scene.geometry.triangles.size(); ++i) {
    if (i == own) continue;
    const Corners t = corners(scene, i);
    const Vec3d a = t.a - from, b = t.b - from, c = t.c - from;
    const double u = dot(way, cross(a, b)), v = dot(way, cross(b, c)), w = dot(way, cross(c, a));
    if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) continue;
    const double distance = dot(a, cross(b, c)) / (u + v + w);
    if (distance > 1e-4 && distance < reach) return true;
  }
  return false;
}

// Does sunlight reach the point? Under water it comes steeper (Snell, double).
bool sees_sun(const RenderScene& scene, Vec3d p, bool in_water, std::size_t own) {
  if (in_water && p.y < 0) {
    const double eta = 1 / double(scene.waters[0].ior);
    const double sine_x = kSun.x * eta, sine_z = kSun.z * eta, down = std::sqrt(1 - sine_x * sine_x - sine_z * sine_z);
    const Vec3d up{-sine_x, down, -sine_z};
    const double reach = -p.y / down;
    if (blocked(scene, p, up, reach, own)) return false;
    p = p + up * reach;
  }
  return !blocked(scene, p, -kSun, 1e9, own);
}

struct Count {
  int lit = 0, dark = 0, wrong = 0;
};

}  // namespace

TEST_CASE("shadows are those of rays, in the air, through water and under it") {
  struct How {
    Shadows shadows;
    const char* method;
    double margin;  // from edges
  };
  // Texels are under 2 cm here; look-ups reach 4 of them. Rays start a hair off their surface.
  const How how = GENERATE(How{Shadows::kMap, "hybrid", 0.09}, How{Shadows::kRays, "hybrid", 1e-3},
                           How{Shadows::kRays, "ray-traced", 1e-3});
  const bool dry = GENERATE(false, true);
  RenderScene scene = make_scene();
  if (dry) scene.waters.clear();
  RenderScene night = scene;
  night.lighting.directional[0].irradiance = {0, 0, 0};
  const double margin = how.margin;
  const auto settings_with = [&](Shadows shadows) {
    FrameSettings settings = settings_of(shadows);
    settings.method = how.method;
    return settings;
  };
  const Vec3d side = unit(cross(kSun, Vec3d{0, 1, 0})), other = cross(kSun, side);
  for (std::size_t camera = 0; camera < 3; ++camera) {
    const Frame mapped = render(scene, settings_with(how.shadows), camera);
    const Frame open = render(scene, settings_with(Shadows::kOff), camera);
    const Frame dark = render(night, settings_with(Shadows::kOff), camera);
    Count air, water;
    for (std::size_t pixel = 0; pixel < open.linear.size() / 4; ++pixel) {
      const std::uint32_t kind = aov(open, Aov::kHitKind).uints[pixel];
      const bool through = kind == 1;
      if (kind > 1) continue;
      const std::size_t id = aov(open, through ? Aov::kHitId : Aov::kIdTriangle).uints[pixel];
      if (id >= scene.geometry.triangles.size()) continue;
      const std::vector<float>& from = aov(open, through ? Aov::kHitPosition : Aov::kPosition).floats;
      const Vec3d p{from[3 * pixel], from[3 * pixel + 1], from[3 * pixel + 2]};
      const Corners t = corners(scene, id);
      if (-dot(unit(cross(t.b - t.a, t.c - t.a)), kSun) < 0.15) continue;
      // The medium of the point: seen from above through the surface, or from the eye under it.
      const bool in_water = !dry && through != (camera == 1);
      const bool lit = sees_sun(scene, p, in_water, id);
      bool near_edge = false;
      for (const Vec3d off : {side, -side, other, -other, side + other, side - other, other - side, -side - other})
        near_edge |= sees_sun(scene, p + off * margin, in_water, id) != lit;
      if (near_edge) continue;
      const Frame& expected = lit ? open : dark;
      Count& count = in_water && p.y < 0 ? water : air;
      (lit ? count.lit : count.dark) += 1;
      count.wrong += std::memcmp(&mapped.linear[4 * pixel], &expected.linear[4 * pixel], 12) != 0;
    }
    CAPTURE(how.method, how.margin, dry, camera, air.lit, air.dark, water.lit, water.dark);
    CHECK(air.wrong == 0);
    CHECK(water.wrong == 0);
    CHECK((dry ? air : water).lit > 200);
    CHECK((dry ? air : water).dark > 50);
    if (camera != 1) CHECK(air.lit + air.dark > 100);
  }
}

TEST_CASE("a coarse ball with smooth normals does not shade its own lit facets") {
  // Twelve facets round and six down: interpolated normals are up to 15 degrees off the facets'.
  Scene scene;
  MeshPrimitive ball;
  const double pi = 3.14159265358979;
  for (int i = 0; i <= 6; ++i) {
    for (int j = 0; j < 12; ++j) {
      const double a = pi * i / 6, b = pi * j / 6;
      const Vec3f p{float(std::sin(a) * std::cos(b)), float(std::cos(a)), float(std::sin(a) * std::sin(b))};
      ball.positions.push_back(p);
      ball.normals.push_back(p);
      if (i == 6) continue;
      const auto at = [&](int down, int round) { return std::uint32_t(12 * (i + down) + (j + round) % 12); };
      for (const std::uint32_t k : {at(0, 0), at(0, 1), at(1, 1), at(0, 0), at(1, 1), at(1, 0)})
        ball.indices.push_back(k);
    }
  }
  scene.materials.materials.resize(1);
  scene.meshes.push_back({"ball", {ball}});
  Node node, sun;
  node.mesh = 0;
  scene.nodes.push_back(node);
  sun.light = 0;
  sun.world_from_local = aimed({0, 0, 0}, kSun);
  scene.lights.push_back({{1, 1, 1}, 3});
  scene.nodes.push_back(sun);
  const bool water = GENERATE(false, true);
  if (water) {  // over all of it
    Node body;
    body.water = 0;
    body.world_from_local = frame({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 2, 0});
    WaterSpec spec;
    spec.has_size = spec.has_depth = true;
    spec.size_x = spec.size_z = 20, spec.depth = 10;
    scene.waters.push_back(spec);
    scene.nodes.push_back(body);
  }
  Node camera;
  camera.camera = 0;
  camera.world_from_local = aimed(Vec3d{2.2, 1.4, 1}, {0, 0, 0});
  scene.cameras.resize(1);
  scene.nodes.push_back(camera);
  const RenderScene built = build_render_scene(scene);
  FrameSettings settings = settings_of(Shadows::kMap);
  settings.shadow_map_px = GENERATE(256, 1024);
  const Frame mapped = render(built, settings, 0);
  settings.shadows = Shadows::kOff;
  const Frame open = render(built, settings, 0);
  int lit = 0, wrong = 0;
  for (std::size_t pixel = 0; pixel < open.linear.size() / 4; ++pixel) {
    const std::size_t id = aov(open, Aov::kIdTriangle).uints[pixel];
    if (id >= built.geometry.triangles.size()) continue;
    const Corners t = corners(built, id);
    if (-dot(unit(cross(t.b - t.a, t.c - t.a)), kSun) < 0.3) continue;
    ++lit;
    wrong += std::memcmp(&mapped.linear[4 * pixel], &open.linear[4 * pixel], 12) != 0;
  }
  CAPTURE(water, settings.shadow_map_px, lit);
  CHECK(lit > 1000);
  CHECK(wrong == 0);
}

TEST_CASE("a shear takes bent sunlight to straight") {
  WaterBody body;
  body.normal = {0.6f, 0.8f, 0};
  body.origin = {1, 2, 3};
  for (const float ior : {1.333f, 1.5f, 0.8f}) {
    body.ior = ior;
    const Vec3d d = unit({0.1, -0.9, 0.35}), n = to_double(body.normal);
    const SunBend bend = bend_of(body, {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)});
    REQUIRE(bend.bent);
    // Snell: the parts along the plane are as 1 to the index.
    const Vec3d along = d - n * dot(d, n), below = along * (1 / double(ior));
    const Vec3d refracted = below - n * std::sqrt(1 - dot(below, below));
    // A point three metres along the bent ray lands on the straight one, as deep as it is.
    const double depth = -dot(refracted, n) * 3;
    const Vec3d straight = d * (depth / -dot(d, n)), mapped = refracted * 3.0 + to_double(bend.shear) * depth;
    const Vec3d miss = straight - mapped, turn = to_double(bend.refracted_world) - refracted;
    CHECK(std::sqrt(dot(miss, miss)) < 3e-6);
    CHECK(std::sqrt(dot(turn, turn)) < 3e-7);
  }
  body.ior = 1.333f;
  CHECK(!bend_of(body, body.normal).bent);  // lit from below
  body.ior = 1;
  CHECK(!bend_of(body, -body.normal).bent);  // no water
}

TEST_CASE("shadow maps do not depend on camera, threads, tiles or instruction set") {
  const RenderScene scene = make_scene();
  const auto digests = [&](Isa isa, int threads, int tile, std::size_t camera) {
    FrameSettings s = settings_of(Shadows::kMap);
    s.isa = isa, s.threads = threads, s.tile_px = tile, s.digests = true, s.shadow_map_px = 512;
    return render(scene, s, camera).digests;
  };
  const auto first = digests(supported_isas().front(), 1, 64, 0);
  REQUIRE(first.front().first == "shadow");
  CHECK(digests(supported_isas().front(), 1, 64, 2).front() == first.front());
  for (const Isa isa : supported_isas()) {
    CHECK(digests(isa, 3, 32, 0) == first);
    CHECK(digests(isa, 1, 256, 0) == first);
  }
}

TEST_CASE("no shadows where they are off or no sun shines") {
  RenderScene scene = make_scene();
  FrameSettings s = settings_of(Shadows::kOff);
  s.digests = true;
  CHECK(render(scene, s, 0).digests.front().first != "shadow");
  scene.lighting.directional.clear();
  s.shadows = Shadows::kMap;
  CHECK(render(scene, s, 0).digests.front().first != "shadow");
  s.shadow_map_px = 1000;
  CHECK_THROWS(Renderer(scene, s));
}
