// Valid files: elements, triangles, nodes, materials, cameras and water against values computed by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "core/error.h"
#include "scene/gltf/gltf.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

using nlohmann::json;

bool has_warning(const Scene& scene, const std::string& part) {
  for (const std::string& line : scene.warnings) {
    if (line.find(part) != std::string::npos) return true;
  }
  return false;
}

bool equal(Vec3f a, Vec3f b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

Scene load(const CraftedFile& file) {
  const TemporaryFolder folder;
  const Scene from_text = load_gltf(file.save_gltf(folder / "scene.gltf"));
  const Scene from_glb = load_gltf(file.save_glb(folder / "scene.glb"));
  REQUIRE(from_text.nodes.size() == from_glb.nodes.size());
  REQUIRE(from_text.meshes.size() == from_glb.meshes.size());
  return from_glb;
}

// Four corners of a unit square.
const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

template <class T>
std::vector<std::uint32_t> loaded_indices(const std::vector<T>& corners, int component_type, int mode) {
  CraftedFile file = empty_file();
  const std::size_t positions = file.add_floats(kSquare, "VEC3", 3);
  const std::size_t normals = file.add_floats(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  const std::size_t indices =
      file.add_accessor(corners.data(), corners.size() * sizeof(T), component_type, "SCALAR", corners.size());
  file.add_mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"indices", indices}, {"mode", mode}});
  return load(file).meshes[0].primitives[0].indices;
}

}  // namespace

TEST_CASE("gltf: indices of every width, strips and fans", "[gltf]") {
  const std::vector<std::uint32_t> list = {0, 1, 2, 2, 3, 0};
  CHECK(loaded_indices<std::uint8_t>({0, 1, 2, 2, 3, 0}, 5121, 4) == list);
  CHECK(loaded_indices<std::uint16_t>({0, 1, 2, 2, 3, 0}, 5123, 4) == list);
  CHECK(loaded_indices<std::uint32_t>({0, 1, 2, 2, 3, 0}, 5125, 4) == list);
  // The specification's own formulas, written out.
  CHECK(loaded_indices<std::uint8_t>({3, 0, 2, 1, 3}, 5121, 5) ==
        std::vector<std::uint32_t>{3, 0, 2, 0, 1, 2, 2, 1, 3});
  CHECK(loaded_indices<std::uint8_t>({0, 1, 2, 3}, 5121, 6) == std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0});
}

TEST_CASE("gltf: without indices and normals a primitive is flat", "[gltf]") {
  CraftedFile file = empty_file();
  // Facing +z, facing -x, without area.
  const std::size_t positions = file.add_floats(
      {0, 0, 0, 1, 0, 0, 0, 1, 0, /**/ 0, 0, 0, 0, 0, 2, 0, 2, 0, /**/ 1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3", 3);
  file.add_mesh({{"attributes", {{"POSITION", positions}}}});
  const MeshPrimitive mesh = load(file).meshes[0].primitives[0];
  REQUIRE(mesh.normals.size() == 9);
  CHECK(mesh.indices == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8});
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(equal(mesh.normals[i], {0, 0, 1}));
    CHECK(equal(mesh.normals[3 + i], {-1, 0, 0}));
    CHECK(equal(mesh.normals[6 + i], {0, 1, 0}));
  }
}

TEST_CASE("gltf: shared vertices are split for flat normals", "[gltf]") {
  CraftedFile file = empty_file();
  const std::size_t positions = file.add_floats(kSquare, "VEC3", 3);
  const std::size_t uvs = file.add_floats({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2", 2);
  const std::uint8_t corners[] = {0, 1, 2, 2, 3, 0};
  const std::size_t indices = file.add_accessor(corners, sizeof corners, 5121, "SCALAR", 6);
  file.add_mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}, {"indices", indices}});
  const MeshPrimitive mesh = load(file).meshes[0].primitives[0];
  REQUIRE(mesh.positions.size() == 6);
  REQUIRE(mesh.uvs.size() == 6);
  CHECK(equal(mesh.positions[4], {0, 1, 0}));
  CHECK((mesh.uvs[4].x == 0 && mesh.uvs[4].y == 1));
}

TEST_CASE("gltf: normalised integers scale as the specification says", "[gltf]") {
  CraftedFile file = empty_file();
  const std::size_t positions = file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  const std::int8_t normals[] = {0, 0, 127, 0, -128, 0, 0, 127, 0, 0, 0, 0};  // padded to four bytes each
  const std::size_t normal = file.add_accessor(normals, sizeof normals, 5120, "VEC3", 3, true);
  file.root["bufferViews"].back()["byteStride"] = 4;
  const std::uint16_t uvs[] = {0, 65535, 32768, 1, 13107, 52428};
  const std::size_t uv = file.add_accessor(uvs, sizeof uvs, 5123, "VEC2", 3, true);
  const std::uint8_t colors[] = {255, 0, 51, 0, 128, 1, 254, 0, 3, 2, 1, 0};
  const std::size_t color = file.add_accessor(colors, sizeof colors, 5121, "VEC3", 3, true);
  file.root["bufferViews"].back()["byteStride"] = 4;
  file.add_mesh(
      {{"attributes", {{"POSITION", positions}, {"NORMAL", normal}, {"TEXCOORD_0", uv}, {"COLOR_0", color}}}});
  const MeshPrimitive mesh = load(file).meshes[0].primitives[0];
  CHECK(equal(mesh.normals[0], {0, 0, 1}));
  CHECK(equal(mesh.normals[1], {-1, 0, 0}));  // -128 is clamped to -1
  CHECK(mesh.uvs[0].y == 1.0f);
  CHECK(mesh.uvs[1].x == Approx(32768.0 / 65535.0).epsilon(1e-7));
  CHECK(mesh.uvs[2].y == Approx(0.8).epsilon(1e-7));
  REQUIRE(mesh.colors.size() == 3);
  CHECK(mesh.colors[0].x == 1.0f);
  CHECK(mesh.colors[0].z == Approx(0.2).epsilon(1e-7));
  CHECK(mesh.colors[1].x == Approx(128.0 / 255.0).epsilon(1e-7));
  CHECK(mesh.colors[1].w == 1.0f);
}

TEST_CASE("gltf: quantised positions, interleaved", "[gltf]") {
  CraftedFile file = empty_file();
  struct Vertex {
    std::int16_t x, y, z, pad;
    float u, v;
  };
  const Vertex vertices[] = {{-300, 5, 0, 99, 0.25f, 0.5f}, {300, 5, 7, 99, 1, 2}, {0, 32767, 0, 99, 3, 4}};
  const std::size_t view = file.add_view(vertices, sizeof vertices, sizeof(Vertex));
  file.root["accessors"] = {
      {{"bufferView", view}, {"componentType", 5122}, {"type", "VEC3"}, {"count", 3}},
      {{"bufferView", view}, {"byteOffset", 8}, {"componentType", 5126}, {"type", "VEC2"}, {"count", 3}}};
  file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  file.add_mesh({{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}});
  const MeshPrimitive mesh = load(file).meshes[0].primitives[0];
  CHECK(equal(mesh.positions[0], {-300, 5, 0}));
  CHECK(equal(mesh.positions[2], {0, 32767, 0}));
  CHECK((mesh.uvs[1].x == 1 && mesh.uvs[1].y == 2));
}

TEST_CASE("gltf: sparse accessors, over data and over zeros", "[gltf]") {
  for (const bool over_data : {true, false}) {
    CraftedFile file = empty_file();
    const std::size_t positions = file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    const std::uint16_t which[] = {1, 2};
    const float values[] = {9, 8, 7, 6, 5, 4};
    const std::size_t indices = file.add_view(which, sizeof which);
    const std::size_t replaced = file.add_view(values, sizeof values);
    file.root["accessors"][0]["sparse"] = {{"count", 2},
                                           {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", replaced}}}};
    if (!over_data) file.root["accessors"][0].erase("bufferView");
    file.add_mesh({{"attributes", {{"POSITION", positions}}}});
    const MeshPrimitive mesh = load(file).meshes[0].primitives[0];
    CHECK(equal(mesh.positions[0], {0, 0, 0}));
    CHECK(equal(mesh.positions[1], {9, 8, 7}));
    CHECK(equal(mesh.positions[2], {6, 5, 4}));
  }
}

TEST_CASE("gltf: nodes come depth first, their transforms multiplied", "[gltf]") {
  CraftedFile file = empty_file();
  const double h = std::sqrt(0.5);
  file.root["nodes"] = {
      {{"name", "c"}, {"translation", {1, 0, 0}}},
      {{"name", "root"}, {"translation", {10, 20, 30}}, {"rotation", {0, h, 0, h}}, {"children", {3, 0}}},
      {{"name", "second"}, {"matrix", {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1}}},
      {{"name", "a"}, {"scale", {2, 3, -4}}, {"children", {4}}},
      {{"name", "b"}, {"translation", {1, 1, 1}}, {"rotation", {0, 0, 3, 0}}}};
  file.root["scenes"][0]["nodes"] = {1, 2};
  const Scene scene = load(file);
  std::string order;
  for (const Node& node : scene.nodes) order += node.name + " ";
  REQUIRE(order == "root a b c second ");
  CHECK(scene.nodes[0].parent == kNoIndex);
  CHECK(scene.nodes[1].parent == 0);
  CHECK(scene.nodes[2].parent == 1);
  CHECK(scene.nodes[3].parent == 0);
  // A quarter turn about y takes x to -z and z to x.
  const auto check_point = [](const Mat4& m, Vec3d p, Vec3d expected) {
    CHECK(m[0].x * p.x + m[1].x * p.y + m[2].x * p.z + m[3].x == Approx(expected.x).margin(1e-5));
    CHECK(m[0].y * p.x + m[1].y * p.y + m[2].y * p.z + m[3].y == Approx(expected.y).margin(1e-5));
    CHECK(m[0].z * p.x + m[1].z * p.y + m[2].z * p.z + m[3].z == Approx(expected.z).margin(1e-5));
  };
  check_point(scene.nodes[0].world_from_local, {1, 2, 3}, {10 + 3, 20 + 2, 30 - 1});
  check_point(scene.nodes[1].world_from_local, {1, 2, 3}, {10 - 12, 20 + 6, 30 - 2});
  // b: half a turn about z (an unnormalised quaternion), then (1, 1, 1), then a's scale, then root.
  check_point(scene.nodes[2].world_from_local, {1, 2, 3}, {10 - 16, 20 - 3, 30 - 0});
  check_point(scene.nodes[4].world_from_local, {1, 2, 3}, {5 - 4, 6 + 2, 7 + 6});
}

TEST_CASE("gltf: the default scene, else the first", "[gltf]") {
  CraftedFile file = empty_file();
  file.root["nodes"] = {{{"name", "one"}}, {{"name", "two"}}};
  file.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  file.root["scene"] = 1;
  CHECK(load(file).nodes[0].name == "two");
  CHECK(has_warning(load(file), "scenes other than"));
  file.root.erase("scene");
  CHECK(load(file).nodes[0].name == "one");
}

TEST_CASE("gltf: cameras and lights", "[gltf]") {
  CraftedFile file = empty_file();
  file.root["cameras"] = {
      {{"type", "perspective"}, {"name", "lens"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3.0}, {"znear", 0}, {"zfar", 10}}}}};
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}}, {{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0.25}}}};
  const json names_light_0 = {{"KHR_lights_punctual", {{"light", 0}}}};
  const json names_light_1 = {{"KHR_lights_punctual", {{"light", 1}}}};
  file.root["nodes"] = {{{"camera", 0}},
                        {{"camera", 1}, {"name", "top"}},
                        {{"extensions", names_light_0}},
                        {{"extensions", names_light_1}}};
  file.root["scenes"][0]["nodes"] = {0, 1, 2, 3};
  const Scene scene = load(file);
  REQUIRE(scene.cameras.size() == 2);
  CHECK(!scene.cameras[0].orthographic);
  CHECK(scene.cameras[0].yfov == 0.5f);
  CHECK(scene.cameras[0].znear == 0.25f);
  CHECK(scene.cameras[0].zfar == 0);
  CHECK(scene.cameras[1].orthographic);
  CHECK((scene.cameras[1].xmag == 2 && scene.cameras[1].ymag == 3 && scene.cameras[1].zfar == 10));
  CHECK(scene.nodes[0].name == "lens");
  CHECK(scene.nodes[1].name == "top");
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.nodes[2].light == 0);
  CHECK(scene.nodes[3].light == 1);
  CHECK(scene.lights[0].kind == LightKind::kPoint);
  CHECK(scene.lights[1].kind == LightKind::kDirectional);
  CHECK(scene.lights[1].intensity == 3);
  CHECK(equal(scene.lights[1].color, {1, 0.5f, 0.25f}));
}

TEST_CASE("gltf: materials, samplers and what is only warned of", "[gltf]") {
  CraftedFile file = good_file();
  file.root["samplers"][0] = {{"wrapS", 33648}, {"wrapT", 33071}, {"magFilter", 9728}, {"minFilter", 9985}};
  file.root["materials"][0] = {{"pbrMetallicRoughness",
                                {{"baseColorFactor", {0.5, 0.25, 0.125, 0.75}},
                                 {"baseColorTexture", {{"index", 0}}},
                                 {"metallicFactor", 0.25},
                                 {"roughnessFactor", 0.5}}},
                               {"emissiveFactor", {0.5, 0, 1}},
                               {"normalTexture", {{"index", 0}}},
                               {"alphaMode", "MASK"},
                               {"alphaCutoff", 0.25},
                               {"doubleSided", true},
                               {"extensions",
                                {{"KHR_materials_unlit", json::object()},
                                 {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
                                 {"EXT_glitter", json::object()}}}};
  file.root["extensionsUsed"] = {"EXT_glitter", "KHR_materials_unlit"};
  const Scene scene = load(file);
  REQUIRE(scene.materials.materials.size() == 1);
  const Material& m = scene.materials.materials[0];
  CHECK((m.base_color.x == 0.5f && m.base_color.y == 0.25f && m.base_color.z == 0.125f && m.base_color.w == 0.75f));
  CHECK((m.metallic == 0.25f && m.roughness == 0.5f));
  CHECK(equal(m.emissive, {2, 0, 4}));
  CHECK(m.alpha_mode == AlphaMode::kMask);
  CHECK(m.alpha_cutoff == 0.25f);
  CHECK((m.double_sided && m.unlit));
  CHECK(m.base_color_sampler.wrap_u == Wrap::kMirror);
  CHECK(m.base_color_sampler.wrap_v == Wrap::kClamp);
  CHECK(m.base_color_sampler.magnify == Filter::kNearest);
  CHECK(m.base_color_sampler.minify == Filter::kLinear);
  CHECK(m.base_color_sampler.mip == MipFilter::kNearest);
  REQUIRE(scene.materials.textures.size() == 1);
  CHECK(texture_bytes(scene.materials.textures[0]) == std::vector<std::uint8_t>{10, 20, 30, 255});
  CHECK(m.normal.texture == kNoTexture);  // nothing of an unlit material would show it
  CHECK(has_warning(scene, "EXT_glitter"));
  CHECK(scene.warnings.size() == 1);
}

TEST_CASE("gltf: a primitive without material gets a default one", "[gltf]") {
  CraftedFile file = good_file();
  const std::size_t positions = 0;
  file.add_mesh({{"attributes", {{"POSITION", positions}}}});
  file.add_mesh({{"attributes", {{"POSITION", positions}}}});
  const Scene scene = load(file);
  REQUIRE(scene.materials.materials.size() == 2);
  CHECK(scene.meshes[0].primitives[0].material == 0);
  CHECK(scene.meshes[1].primitives[0].material == 1);
  CHECK(scene.meshes[2].primitives[0].material == 1);
  CHECK(scene.materials.materials[1].metallic == 1);
}

TEST_CASE("gltf: the base colour's coordinate set and its transform", "[gltf]") {
  CraftedFile file = good_file();
  const std::size_t second = file.add_floats({1, 0, 0, 1, 1, 1}, "VEC2", 2);
  file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = second;
  json& info = file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  info["texCoord"] = 1;
  // A quarter turn: the extension's matrix is (cos, sin; -sin, cos), so (1, 0) goes to (0, -1) and (0, 1) to (1, 0).
  info["extensions"]["KHR_texture_transform"] = {{"offset", {0.5, 2}}, {"scale", {2, 4}}, {"rotation", 1.57079632679}};
  const Scene scene = load(file);
  const MeshPrimitive& mesh = scene.meshes[0].primitives[0];
  const UvMap& map = scene.materials.materials[0].base_color_uv;
  CHECK((map.set == 0 && mesh.uvs1.empty()));  // the only set that is used is the first
  const auto moved = [&](std::size_t i) { return transform_uv<float>(map, {mesh.uvs[i], {0, 0}, {0, 0}}).uv; };
  CHECK(moved(0).x == Approx(0.5).margin(1e-6));
  CHECK(moved(0).y == Approx(2 - 2).margin(1e-6));
  CHECK(moved(1).x == Approx(0.5 + 4).margin(1e-6));
  CHECK(moved(1).y == Approx(2).margin(1e-6));
  CHECK(moved(2).x == Approx(0.5 + 4).margin(1e-6));
  CHECK(moved(2).y == Approx(0).margin(1e-6));
}

TEST_CASE("gltf: maps, their factors, sets of coordinates and colour spaces", "[gltf]") {
  CraftedFile file = good_file();
  const std::size_t second = file.add_floats({1, 0, 0, 1, 1, 1}, "VEC2", 2);
  file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_3"] = second;
  json& material = file.root["materials"][0];
  material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}, {"texCoord", 3}};
  material["normalTexture"] = {{"index", 0}, {"scale", -2}};
  material["occlusionTexture"] = {{"index", 0}, {"strength", 0.25}};
  material["emissiveTexture"] = {{"index", 0}};
  material["emissiveFactor"] = {0, 1, 0};
  material["extensions"]["KHR_materials_ior"]["ior"] = 1.25;
  const Scene scene = load(file);
  const Material& m = scene.materials.materials[0];
  // One image, as a colour and as data.
  REQUIRE(scene.materials.textures.size() == 2);
  CHECK(scene.materials.textures[0].format == TexelFormat::kRgba8Srgb);
  CHECK(scene.materials.textures[1].format == TexelFormat::kRgba8Linear);
  CHECK((m.base_color_texture == 0 && m.emission.texture == 0));
  CHECK((m.metallic_roughness.texture == 1 && m.normal.texture == 1 && m.occlusion.texture == 1));
  CHECK((m.normal_scale == -2 && m.occlusion_strength == 0.25f && m.ior == 1.25f));
  CHECK((m.normal.uv.set == 0 && m.metallic_roughness.uv.set == 1));
  const MeshPrimitive& mesh = scene.meshes[0].primitives[0];
  REQUIRE(mesh.uvs1.size() == 3);
  CHECK((mesh.uvs1[1].x == 0 && mesh.uvs1[1].y == 1));
  CHECK(mesh.tangents.size() == mesh.positions.size());  // generated
  CHECK(scene.warnings.empty());

  const std::size_t tangents = file.add_floats({0, 2, 0, 1, 0, 1, 0, -1, 0, 1, 0, -1}, "VEC4", 4);
  file.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = tangents;
  const MeshPrimitive given = load(file).meshes[0].primitives[0];
  REQUIRE(given.tangents.size() == 3);
  CHECK((given.tangents[0].y == 1 && given.tangents[0].w == 1 && given.tangents[1].w == -1));
}

TEST_CASE("gltf: water from an object, from flat keys, from a check box", "[gltf]") {
  const auto water_of = [](const json& extras) {
    CraftedFile file = good_file();
    file.root["nodes"][3]["extras"] = extras;
    file.root["nodes"][3]["mesh"] = 0;
    return load(file);
  };
  SECTION("object") {
    const Scene scene = water_of({{"water",
                                   {{"size", {4, 3}},
                                    {"depth", 2},
                                    {"ior", 1.5},
                                    {"absorption", {1, 2, 3}},
                                    {"surface", {{"type", "flat"}}},
                                    {"geometry", "displaced"}}}});
    REQUIRE(scene.waters.size() == 1);
    CHECK(scene.nodes[3].water == 0);
    const WaterSpec& water = scene.waters[0];
    CHECK((water.has_size && water.size_x == 4 && water.size_z == 3));
    CHECK((water.has_depth && water.depth == 2));
    CHECK(water.ior == 1.5f);
    CHECK(equal(water.absorption, {1, 2, 3}));
    CHECK(water.surface.geometry == WaterGeometry::kDisplaced);
    CHECK(scene.warnings.empty());
  }
  SECTION("flat keys") {
    const Scene scene = water_of({{"water_ior", 1.0}, {"water_size", {1, 2}}, {"water_absorption", {0, 0, 0}}});
    REQUIRE(scene.waters.size() == 1);
    CHECK(scene.waters[0].ior == 1);
    CHECK(scene.waters[0].size_z == 2);
    CHECK(equal(scene.waters[0].absorption, {0, 0, 0}));
    CHECK(!scene.waters[0].has_depth);
  }
  SECTION("check box, mesh as outline") {
    const Scene scene = water_of({{"water", true}});
    REQUIRE(scene.waters.size() == 1);
    CHECK(!scene.waters[0].has_size);
    CHECK(scene.waters[0].ior == 1.333f);
  }
  SECTION("none") {
    CHECK(water_of({{"water", false}, {"water_ior", 1.2}}).waters.empty());
    CHECK(water_of({{"other", 5}}).waters.empty());
  }
  SECTION("surfaces") {
    const SurfaceSettings ripples = water_of({{"water",
                                               {{"surface",
                                                 {{"drops", {{1, 2, 0.5}, {-3, 4, 1}}},
                                                  {"slope", 0.1},
                                                  {"falloff", "exponential"},
                                                  {"type", "ripples"}}}}}})
                                        .waters.at(0)
                                        .surface;
    CHECK(ripples.kind == SurfaceKind::kRipples);
    CHECK(ripples.slope == 0.1f);
    CHECK(ripples.falloff == RippleFalloff::kExponential);
    REQUIRE(ripples.drops.size() == 2);
    CHECK(ripples.drops[1].z_m == 4.0f);
    const SurfaceSettings flat_keys =
        water_of({{"water_octaves", 3}, {"water_seed", 4000000000.0}, {"water_surface", "perlin"}})
            .waters.at(0)
            .surface;
    CHECK(flat_keys.kind == SurfaceKind::kPerlin);
    CHECK(flat_keys.octaves == 3);
    CHECK(flat_keys.seed == 4000000000u);
    const SurfaceSettings sum =
        water_of({{"water",
                   {{"surface",
                     {{"parts", {{{"type", "spectrum"}, {"slope", 0.2}}, {{"type", "perlin"}, {"octaves", 2}}}}}}}}})
            .waters.at(0)
            .surface;
    CHECK(sum.kind == SurfaceKind::kSum);
    REQUIRE(sum.parts.size() == 2);
    CHECK(sum.parts[0].slope == 0.2f);
    CHECK(sum.parts[1].octaves == 2);
    const SurfaceSettings plus =
        water_of({{"water_type", "spectrum+perlin"}, {"water_wavelength", 3}}).waters.at(0).surface;
    REQUIRE(plus.parts.size() == 2);
    CHECK(plus.parts[1].wavelength_m == 3.0f);
    CHECK(has_warning(water_of({{"water", {{"surface", {{"tpye", "flat"}}}}}}), "'tpye' is not known"));
  }
}

TEST_CASE("gltf: backgrounds", "[gltf]") {
  CraftedFile file = good_file();
  CHECK(!load(file).has_background);
  file.root["scenes"][0]["extras"]["background"] = {0.25, 0.5, 1};
  CHECK(load(file).background.kind == Background::Kind::kColor);
  CHECK(equal(load(file).background.color, {0.25f, 0.5f, 1}));
  file.root["scenes"][0]["extras"]["background"] = "sky";
  CHECK(load(file).background.kind == Background::Kind::kSky);
  file.root["scenes"][0]["extras"]["background"] = {{"type", "sky"}, {"zenith", {0, 0, 1}}, {"to_sun", {0, 0.6, 0.8}}};
  CHECK(equal(load(file).background.zenith, {0, 0, 1}));
  CHECK(equal(load(file).background.to_sun_world, {0, 0.6f, 0.8f}));
}

TEST_CASE("gltf: files beside the scene, names with spaces", "[gltf]") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "sub folder");
  CraftedFile file = good_file();
  write_file(folder / "sub folder/da+ta 100%.bin", file.bin);
  write_file(folder / "brick.png", png(1, 1, 6, 8, {1, 2, 3, 4}));
  file.root["buffers"][0]["uri"] = "sub%20folder/da+ta%20100%25.bin";
  file.root["images"][0] = {{"uri", "./brick.png"}};
  const Scene scene = load_gltf(file.save_gltf(folder / "scene with spaces.gltf"));
  CHECK(equal(scene.meshes[0].primitives[0].positions[1], {1, 0, 0}));
  CHECK(texture_bytes(scene.materials.textures[0]) == std::vector<std::uint8_t>{1, 2, 3, 4});
}

TEST_CASE("gltf: whole numbers may be written as 3.0", "[gltf]") {
  CraftedFile file = good_file();
  file.root["accessors"][0]["count"] = 3.0;
  file.root["accessors"][0]["bufferView"] = 0.0;
  file.root["scenes"][0]["nodes"] = {0.0, 1.0};
  CHECK(load(file).meshes[0].primitives[0].positions.size() == 3);
}

TEST_CASE("gltf: points and lines are warned of, the triangles beside them drawn", "[gltf]") {
  CraftedFile file = good_file();
  json& primitives = file.root["meshes"][0]["primitives"];
  primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
  primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 3}});
  const Scene scene = load(file);
  CHECK(scene.meshes[0].primitives.size() == 1);
  CHECK(has_warning(scene, "points are not drawn"));
  CHECK(has_warning(scene, "lines are not drawn"));
}

}  // namespace shoal::test
