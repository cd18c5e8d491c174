// A written scene is read back unchanged, and writing it again gives the same bytes.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "core/error.h"
#include "scene/gltf/export_glb.h"
#include "scene/gltf/gltf.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void check_same(const Texture& a, const Texture& b) {
  CHECK(a.format == b.format);
  CHECK(a.level_count == b.level_count);
  CHECK(same_bits(a.width, b.width));
  CHECK(same_bits(a.height, b.height));
  CHECK(same_bits(a.first_texel, b.first_texel));
  CHECK(same_bits(a.rgba15, b.rgba15));
  CHECK(same_bits(a.rgba32f, b.rgba32f));
}

void check_same(const UvMap& a, const UvMap& b) {
  CHECK(a.set == b.set);
  CHECK(a.transformed == b.transformed);
  CHECK(same_bits(a.offset, b.offset));
  CHECK(same_bits(a.scale, b.scale));
  CHECK(same_bits(a.rotation, b.rotation));
  CHECK(same_bits(a.row, b.row));
}

void check_same(const MaterialMap& a, const MaterialMap& b) {
  CHECK(a.texture == b.texture);
  CHECK(a.sampler.wrap_u == b.sampler.wrap_u);
  CHECK(a.sampler.minify == b.sampler.minify);
  check_same(a.uv, b.uv);
}

void check_same(const Material& a, const Material& b) {
  CHECK(same_bits(a.base_color, b.base_color));
  CHECK(a.base_color_texture == b.base_color_texture);
  CHECK(a.base_color_sampler.wrap_u == b.base_color_sampler.wrap_u);
  CHECK(a.base_color_sampler.wrap_v == b.base_color_sampler.wrap_v);
  CHECK(a.base_color_sampler.magnify == b.base_color_sampler.magnify);
  CHECK(a.base_color_sampler.minify == b.base_color_sampler.minify);
  CHECK(a.base_color_sampler.mip == b.base_color_sampler.mip);
  CHECK(same_bits(a.metallic, b.metallic));
  CHECK(same_bits(a.roughness, b.roughness));
  CHECK(same_bits(a.emissive, b.emissive));
  CHECK(a.alpha_mode == b.alpha_mode);
  CHECK(same_bits(a.alpha_cutoff, b.alpha_cutoff));
  CHECK(a.double_sided == b.double_sided);
  CHECK(a.unlit == b.unlit);
  check_same(a.base_color_uv, b.base_color_uv);
  check_same(a.metallic_roughness, b.metallic_roughness);
  check_same(a.normal, b.normal);
  check_same(a.occlusion, b.occlusion);
  check_same(a.emission, b.emission);
  CHECK(same_bits(a.normal_scale, b.normal_scale));
  CHECK(same_bits(a.occlusion_strength, b.occlusion_strength));
  CHECK(same_bits(a.ior, b.ior));
}

void check_same(const SurfaceSettings& a, const SurfaceSettings& b) {
  CHECK(a.kind == b.kind);
  CHECK(a.slope == b.slope);
  CHECK(a.amplitude_m == b.amplitude_m);
  CHECK(a.octaves == b.octaves);
  CHECK(same_bits(a.gain, b.gain));
  CHECK(a.seed == b.seed);
  CHECK(a.fade == b.fade);
  CHECK(a.falloff == b.falloff);
  CHECK(a.filter == b.filter);
  REQUIRE(a.drops.size() == b.drops.size());
  for (std::size_t i = 0; i < a.drops.size(); ++i) {
    CHECK(same_bits(a.drops[i].x_m, b.drops[i].x_m));
    CHECK(same_bits(a.drops[i].time_s, b.drops[i].time_s));
  }
  REQUIRE(a.parts.size() == b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) check_same(a.parts[i], b.parts[i]);
}

void check_same(const WaterSpec& a, const WaterSpec& b) {
  CHECK(a.has_size == b.has_size);
  CHECK(same_bits(a.size_x, b.size_x));
  CHECK(same_bits(a.size_z, b.size_z));
  CHECK(a.has_depth == b.has_depth);
  CHECK(same_bits(a.depth, b.depth));
  CHECK(same_bits(a.ior, b.ior));
  CHECK(same_bits(a.absorption, b.absorption));
  CHECK(a.surface.geometry == b.surface.geometry);
  check_same(a.surface, b.surface);
}

void check_same(const Background& a, const Background& b) {
  CHECK(a.kind == b.kind);
  CHECK(same_bits(a.color, b.color));
  CHECK(same_bits(a.zenith, b.zenith));
  CHECK(same_bits(a.horizon, b.horizon));
  CHECK(same_bits(a.ground, b.ground));
  CHECK(same_bits(a.to_sun_world, b.to_sun_world));
  CHECK(same_bits(a.sun, b.sun));
}

void check_same_meshes(const Scene& a, const Scene& b) {
  REQUIRE(a.meshes.size() == b.meshes.size());
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    CHECK(a.meshes[m].name == b.meshes[m].name);
    REQUIRE(a.meshes[m].primitives.size() == b.meshes[m].primitives.size());
    for (std::size_t p = 0; p < a.meshes[m].primitives.size(); ++p) {
      const MeshPrimitive& x = a.meshes[m].primitives[p];
      const MeshPrimitive& y = b.meshes[m].primitives[p];
      CHECK(same_bits(x.positions, y.positions));
      CHECK(same_bits(x.normals, y.normals));
      CHECK(same_bits(x.uvs, y.uvs));
      CHECK(same_bits(x.colors, y.colors));
      CHECK(same_bits(x.uvs1, y.uvs1));
      CHECK(same_bits(x.tangents, y.tangents));
      CHECK(x.indices == y.indices);
      CHECK(x.material == y.material);
    }
  }
}

void check_same(const Scene& a, const Scene& b) {
  REQUIRE(a.nodes.size() == b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const Node& x = a.nodes[i];
    const Node& y = b.nodes[i];
    CHECK(x.name == y.name);
    CHECK(x.parent == y.parent);
    // By value: a product with the parent's transform makes 0 of -0.
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) CHECK(x.world_from_local[c][r] == y.world_from_local[c][r]);
    }
    CHECK(x.mesh == y.mesh);
    CHECK(x.camera == y.camera);
    CHECK(x.light == y.light);
    CHECK(x.water == y.water);
  }
  check_same_meshes(a, b);
  REQUIRE(a.cameras.size() == b.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    CHECK(a.cameras[i].orthographic == b.cameras[i].orthographic);
    if (a.cameras[i].orthographic) {
      CHECK(same_bits(a.cameras[i].xmag, b.cameras[i].xmag));
      CHECK(same_bits(a.cameras[i].ymag, b.cameras[i].ymag));
    } else {
      CHECK(same_bits(a.cameras[i].yfov, b.cameras[i].yfov));
    }
    CHECK(same_bits(a.cameras[i].znear, b.cameras[i].znear));
    CHECK(same_bits(a.cameras[i].zfar, b.cameras[i].zfar));
  }
  REQUIRE(a.lights.size() == b.lights.size());
  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    CHECK(same_bits(a.lights[i].color, b.lights[i].color));
    CHECK(same_bits(a.lights[i].intensity, b.lights[i].intensity));
    CHECK(a.lights[i].kind == b.lights[i].kind);
    CHECK(same_bits(a.lights[i].range_m, b.lights[i].range_m));
    CHECK(same_bits(a.lights[i].inner_cone, b.lights[i].inner_cone));
    CHECK(same_bits(a.lights[i].outer_cone, b.lights[i].outer_cone));
  }
  REQUIRE(a.waters.size() == b.waters.size());
  for (std::size_t i = 0; i < a.waters.size(); ++i) check_same(a.waters[i], b.waters[i]);
  REQUIRE(a.materials.materials.size() == b.materials.materials.size());
  for (std::size_t i = 0; i < a.materials.materials.size(); ++i) {
    check_same(a.materials.materials[i], b.materials.materials[i]);
  }
  REQUIRE(a.materials.textures.size() == b.materials.textures.size());
  for (std::size_t i = 0; i < a.materials.textures.size(); ++i) {
    check_same(a.materials.textures[i], b.materials.textures[i]);
  }
  CHECK(a.has_background == b.has_background);
  check_same(a.background, b.background);
}

MeshPrimitive triangle(float size) {
  MeshPrimitive mesh;
  mesh.positions = {{0, 0, 0}, {size, -0.0f, 1e-40f}, {0.1f, size / 3, -7.7e7f}};
  mesh.normals = {{0, 0, 1}, {0.6f, 0.8f, 0}, {0, -1, 0}};
  mesh.indices = {2, 1, 0};
  return mesh;
}

// Every field of every structure away from its default somewhere.
Scene full_scene() {
  Scene scene;
  const std::uint8_t texels[] = {255, 0,   7,   0,   1,   2,   3,  4, 9, 99, 199, 255,
                                 128, 127, 126, 125, 200, 100, 50, 1, 0, 0,  0,   0};
  const float radiance[] = {0.1f, 1e6f, 0, 1, 3.3f, 2e-20f, 0.7f, 0.25f};
  scene.materials.textures = {make_texture_rgba8(3, 2, texels, true), make_texture_rgba8(2, 3, texels, false),
                              make_texture_float(2, 1, radiance)};
  scene.materials.materials.resize(5);
  Material& first = scene.materials.materials[0];
  first.base_color = {0.1f, 0.2f, 0.3f, 0.4f};
  first.base_color_texture = 2;
  first.base_color_sampler = {Wrap::kMirror, Wrap::kClamp, Filter::kNearest, Filter::kNearest, MipFilter::kNone};
  first.metallic = 0.7f;
  first.roughness = 0.05f;
  first.emissive = {0.3f, 123.456f, 0};
  first.alpha_mode = AlphaMode::kMask;
  first.alpha_cutoff = 0.3f;
  first.double_sided = true;
  scene.materials.materials[1].base_color_texture = 0;
  scene.materials.materials[1].unlit = true;
  scene.materials.materials[2].base_color_texture = 1;
  scene.materials.materials[2].base_color_sampler.minify = Filter::kNearest;
  scene.materials.materials[2].emissive = {0.1f, 0.2f, 1};
  scene.materials.materials[3].alpha_mode = AlphaMode::kBlend;
  scene.materials.materials[3].base_color_texture = 0;
  scene.materials.materials[3].base_color_sampler.mip = MipFilter::kNearest;
  scene.materials.materials[3].base_color_sampler.wrap_v = Wrap::kMirror;

  Material& mapped = scene.materials.materials[4];  // of meshes[1]
  mapped.base_color_texture = 0;
  mapped.base_color_uv = make_uv_map(1, {0.1f, -0.2f}, 0.3f, {3, 0.7f});
  mapped.metallic_roughness = {1, {}, {}};
  mapped.normal = {1, {Wrap::kClamp, Wrap::kRepeat, Filter::kLinear, Filter::kNearest, MipFilter::kLinear}, {}};
  mapped.occlusion = {1, {}, make_uv_map(1, {0, 0}, 0, {2, 2})};
  mapped.emission = {0, {}, {}};
  mapped.emissive = {1, 2, 3};
  mapped.normal_scale = -0.3f;
  mapped.occlusion_strength = 0.7f;
  mapped.ior = 1.31f;

  scene.meshes.resize(2);
  scene.meshes[0].name = "both \"quoted\" \xC3\xBC";
  scene.meshes[0].primitives = {triangle(1), triangle(0.3f)};
  scene.meshes[0].primitives[0].uvs = {{0.1f, -3}, {1e10f, 0}, {0.7f, 0.9f}};
  scene.meshes[0].primitives[0].material = 3;
  scene.meshes[0].primitives[1].colors = {{1, 0.5f, 0.1f, 1}, {0, 0, 0, 0}, {0.3f, 0.2f, 0.1f, 0.9f}};
  scene.meshes[1].primitives = {triangle(5)};
  scene.meshes[1].primitives[0].material = 4;
  scene.meshes[1].primitives[0].uvs = {{0.1f, 0.2f}, {0.3f, 0.4f}, {0.5f, 0.6f}};
  scene.meshes[1].primitives[0].uvs1 = {{1.1f, 0.2f}, {-0.3f, 0.4f}, {1e-20f, 0.6f}};
  scene.meshes[1].primitives[0].tangents = {{0, 0.6f, -0.8f, 1}, {1, 0, 0, -1}, {0, 0, 1, 1}};

  scene.cameras.resize(2);
  scene.cameras[0].yfov = 0.7f;
  scene.cameras[0].znear = 0.013f;
  scene.cameras[0].zfar = 77.7f;
  scene.cameras[1].orthographic = true;
  scene.cameras[1].xmag = 1.1f;
  scene.cameras[1].ymag = 2.3f;
  scene.cameras[1].znear = 0;
  scene.cameras[1].zfar = 55;
  scene.lights = {{{1, 0.9f, 0.1f}, 3.14159f},
                  {{0.3f, 1, 1}, 800.1f, LightKind::kPoint, 7.7f},
                  {{1, 1, 1}, 54.3f, LightKind::kSpot, 0, 0.1f, 1.57079637f}};
  scene.waters.resize(2);
  scene.waters[0].has_size = true;
  scene.waters[0].size_x = 3.3f;
  scene.waters[0].size_z = 0.1f;
  scene.waters[0].has_depth = true;
  scene.waters[0].depth = 1.7f;
  scene.waters[0].ior = 1.0f / 3.0f;
  scene.waters[0].absorption = {0, 0.1f, 1e-3f};
  scene.waters[0].surface.geometry = WaterGeometry::kDisplaced;
  SurfaceSettings& surface = scene.waters[0].surface;
  surface.kind = SurfaceKind::kSum;
  surface.slope = 0.1f;
  surface.parts.resize(2);
  surface.parts[0].kind = SurfaceKind::kPerlin;
  surface.parts[0].amplitude_m = 0.3f;
  surface.parts[0].octaves = 5;
  surface.parts[0].gain = 0.1f;
  surface.parts[0].seed = 4000000001u;
  surface.parts[0].fade = NoiseFade::kCubic;
  surface.parts[1].kind = SurfaceKind::kRipples;
  surface.parts[1].falloff = RippleFalloff::kExponential;
  surface.parts[1].filter = WaveFilter::kNone;
  surface.parts[1].drops = {{1.1f, -2, 0.3f}};

  scene.nodes.resize(7);
  scene.nodes[0].name = "root";
  scene.nodes[0].world_from_local = from_rows({0.1f, -0.0f, 0, 3}, {0, -2.7f, 0, 1e-30f}, {0, 0.3f, 5, 1e7f});
  scene.nodes[1].mesh = 0;
  scene.nodes[2].mesh = 1;
  scene.nodes[2].water = 0;
  scene.nodes[3].camera = 1;
  scene.nodes[4].camera = 0;
  scene.nodes[5].light = 0;
  scene.nodes[6].water = 1;
  scene.nodes[6].mesh = 0;
  scene.has_background = true;
  scene.background.kind = Background::Kind::kSky;
  scene.background.zenith = {0.1f, 0.2f, 0.3f};
  scene.background.horizon = {0.4f, 0.5f, 0.6f};
  scene.background.ground = {0.7f, 0.8f, 0.9f};
  scene.background.to_sun_world = {0.6f, 0.8f, 0};
  scene.background.sun = {10, 9.1f, 8};
  return scene;
}

}  // namespace

TEST_CASE("export: every field comes back bit for bit", "[export]") {
  const TemporaryFolder folder;
  Scene scene = full_scene();
  export_glb(scene, folder / "full.glb");
  check_same(scene, load_gltf(folder / "full.glb"));

  scene.background = Background{};
  scene.background.color = {0.1f, 0.2f, 100};
  export_glb(scene, folder / "color.glb");
  check_same(scene, load_gltf(folder / "color.glb"));
}

TEST_CASE("export: an empty scene", "[export]") {
  const TemporaryFolder folder;
  export_glb(Scene{}, folder / "empty.glb");
  check_same(Scene{}, load_gltf(folder / "empty.glb"));
}

TEST_CASE("export: children keep their place below turned, scaled, mirrored parents", "[export]") {
  const TemporaryFolder folder;
  Scene scene;
  scene.nodes.resize(5);
  // Quarter turn and mirror; a turn by 30 degrees; scale 0.1.
  scene.nodes[0].world_from_local = from_rows({0, 0, 2, 1}, {0, -2, 0, 0.3f}, {2, 0, 0, -7});
  scene.nodes[1].world_from_local = from_rows({0.8660254f, -0.5f, 0, 11}, {0.5f, 0.8660254f, 0, 0}, {0, 0, 1, 0.1f});
  scene.nodes[2].world_from_local = from_rows({0.1f, 0, 0, 5}, {0, 0.1f, 0, 6}, {0, 0, 0.1f, 7});
  scene.nodes[3].world_from_local = from_rows({1, 2, 3, 0}, {0, 1, 4, 0}, {5, 6, 0, 0});
  const std::int32_t parents[] = {kNoIndex, 0, 1, 1, kNoIndex};
  for (std::size_t i = 0; i < 5; ++i) {
    scene.nodes[i].parent = parents[i];
    scene.nodes[i].name = "n" + std::to_string(i);
  }
  export_glb(scene, folder / "tree.glb");
  check_same(scene, load_gltf(folder / "tree.glb"));
}

TEST_CASE("export: what was loaded is written and loaded again the same", "[export]") {
  const TemporaryFolder folder;
  const Scene scene = load_gltf(good_file().save_gltf(folder / "good.gltf"));
  export_glb(scene, folder / "again.glb");
  check_same(scene, load_gltf(folder / "again.glb"));
}

TEST_CASE("export: the built-in scenes come back identical", "[export]") {
  const TemporaryFolder folder;
  for (const ProceduralScene& built_in : procedural_scenes()) {
    CAPTURE(built_in.name);
    const Scene scene = built_in.make(std::min<std::uint64_t>(built_in.default_triangles, 20000));
    export_glb(scene, folder / "built-in.glb");
    const Scene again = load_gltf(folder / "built-in.glb");
    check_same(scene, again);
    CHECK(again.warnings.empty());
  }
}

TEST_CASE("export: the same scene gives the same bytes", "[export]") {
  const TemporaryFolder folder;
  export_glb(full_scene(), folder / "a.glb");
  export_glb(full_scene(), folder / "b.glb");
  const std::vector<std::uint8_t> a = read_whole_file(folder / "a.glb");
  CHECK(a.size() > 1000);
  CHECK(a.size() % 4 == 0);
  CHECK(a == read_whole_file(folder / "b.glb"));
}

TEST_CASE("export: a file that cannot be written leaves nothing and changes nothing", "[export]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(export_glb(full_scene(), folder / "no/such/folder.glb"), Error);
  write_file(folder / "old.glb", std::string("old"));
  Scene broken = full_scene();
  broken.meshes[0].primitives[1].indices[0] = 3;
  CHECK_THROWS_AS(export_glb(broken, folder / "old.glb"), Error);
  const auto old = read_whole_file(folder / "old.glb");
  CHECK(std::string(old.begin(), old.end()) == "old");
  std::filesystem::create_directory(folder / "folder.glb");
  CHECK_THROWS_AS(export_glb(full_scene(), folder / "folder.glb"), Error);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) files += entry.exists() ? 1 : 0;
  CHECK(files == 2);
  if (std::filesystem::exists("/dev/full")) {
    std::FILE* full = std::fopen("/dev/full", "wb");
    REQUIRE(full != nullptr);
    std::setvbuf(full, nullptr, _IONBF, 0);
    CHECK_THROWS_WITH(write_glb(full_scene(), full, "full.glb"),
                      Catch::Matchers::Contains("full.glb: cannot be written"));
    std::fclose(full);
  }
}

TEST_CASE("export: scenes that are not valid are refused", "[export]") {
  const TemporaryFolder folder;
  const auto refused = [&](void (*spoil)(Scene&)) {
    Scene scene = full_scene();
    spoil(scene);
    CHECK_THROWS_AS(export_glb(scene, folder / "x.glb"), Error);
  };
  refused([](Scene& s) { s.nodes[1].mesh = 9; });
  refused([](Scene& s) { s.nodes[0].parent = 3; });
  refused([](Scene& s) { s.nodes[6].parent = 4, s.nodes[5].parent = 0; });
  refused([](Scene& s) { s.meshes[0].primitives[0].normals.pop_back(); });
  refused([](Scene& s) { s.meshes[0].primitives[0].indices.clear(); });
  refused([](Scene& s) { s.meshes[0].primitives[0].material = -1; });
  refused([](Scene& s) { s.materials.materials[0].base_color_texture = 3; });
  refused([](Scene& s) { s.nodes[0].world_from_local = {}, s.nodes[1].parent = 0; });
}

}  // namespace shoal::test
