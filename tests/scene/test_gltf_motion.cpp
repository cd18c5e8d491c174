// Skins, morph targets, animations and instances of files: reading, refusing, and writing again.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "core/error.h"
#include "scene/gltf/export_glb.h"
#include "scene/gltf/gltf.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

using nlohmann::json;

// good_file()'s accessors 0 to 3, then: 4 JOINTS_0, 5 WEIGHTS_0, 6 displacements, 7 inverse bind matrices, 8 times,
// 9 rotations, 10 weights, 11 to 13 instances. Nodes 0 to 3, then: 4 a joint with 5 below it, 6 instanced, morphed.
CraftedFile moving_file() {
  CraftedFile file = good_file();
  json& root = file.root;
  const std::uint8_t joints[] = {0, 0, 0, 0, 0, 1, 0, 0, 1, 9, 0, 0};
  file.add_accessor(joints, sizeof joints, 5121, "VEC4", 3);
  file.add_floats({1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 2, 0, 0, 0}, "VEC4", 4);
  file.add_floats({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3", 3);
  file.add_floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1},
                  "MAT4", 16);
  file.add_floats({0, 0.5f, 2}, "SCALAR", 1);
  file.add_floats({0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC4", 4);
  file.add_floats({0, 1, 0.25f}, "SCALAR", 1);
  file.add_floats({1, 2, 3, 4, 5, 6}, "VEC3", 3);
  const std::int16_t rotations[] = {0, 0, 0, 32767, 0, 32767, 0, 0};
  file.add_accessor(rotations, sizeof rotations, 5122, "VEC4", 2, true);
  file.add_floats({1, 1, 1, 2, 2, 2}, "VEC3", 3);
  json& primitive = root["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] = 4;
  primitive["attributes"]["WEIGHTS_0"] = 5;
  json plain = {{"attributes", {{"POSITION", 0}}}, {"targets", {{{"POSITION", 6}}}}};
  root["meshes"].push_back({{"primitives", {plain}}, {"weights", {0.75}}});
  root["skins"] = json::array({json{{"joints", {4, 5}}, {"inverseBindMatrices", 7}, {"name", "bones"}}});
  root["nodes"][0]["skin"] = 0;
  root["nodes"].push_back({{"children", {5}}, {"translation", {1, 0, 0}}});
  root["nodes"].push_back({{"name", "tip"}});
  root["nodes"].push_back(
      {{"mesh", 1},
       {"name", "herd"},
       {"extensions",
        {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", 11}, {"ROTATION", 12}, {"SCALE", 13}}}}}}}});
  root["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 6};
  root["extensionsUsed"].push_back("EXT_mesh_gpu_instancing");
  root["animations"] = json::array(
      {json{{"name", "wave"},
            {"samplers", {{{"input", 8}, {"output", 9}}, {{"input", 8}, {"output", 10}, {"interpolation", "STEP"}}}},
            {"channels",
             {{{"sampler", 0}, {"target", {{"node", 5}, {"path", "rotation"}}}},
              {{"sampler", 1}, {"target", {{"node", 6}, {"path", "weights"}}}}}}}});
  return file;
}

std::string error_of(const std::string& path, const LoadLimits& limits = {}) {
  try {
    load_gltf(path, limits);
  } catch (const Error& e) {
    return e.what();
  }
  return "loaded";
}

struct Recipe {
  const char* name;
  const char* message_part;
  std::function<void(CraftedFile&)> mutate;
};

void set_float(CraftedFile& f, std::size_t accessor, std::size_t at, float value) {
  const auto view = f.root["accessors"][accessor]["bufferView"].get<std::size_t>();
  const auto first = f.root["bufferViews"][view]["byteOffset"].get<std::size_t>();
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  std::copy(bytes, bytes + 4, f.bin.begin() + static_cast<std::ptrdiff_t>(first + 4 * at));
}
json& attributes(CraftedFile& f) { return f.root["meshes"][0]["primitives"][0]["attributes"]; }
json& wave(CraftedFile& f) { return f.root["animations"][0]; }
json& herd(CraftedFile& f) { return f.root["nodes"][6]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]; }

std::vector<Recipe> skin_recipes() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return {
      {"joint_number", "follows joint 7",
       [](CraftedFile& f) {
         const auto view = f.root["accessors"][4]["bufferView"].get<std::size_t>();
         f.bin[f.root["bufferViews"][view]["byteOffset"].get<std::size_t>() + 5] = 7;
       }},
      {"joints_alone", "expected WEIGHTS_0 beside it", [](CraftedFile& f) { attributes(f).erase("WEIGHTS_0"); }},
      {"weights_alone", "expected JOINTS_0 beside it", [](CraftedFile& f) { attributes(f).erase("JOINTS_0"); }},
      {"joints_of_floats", "5121 or 5123", [](CraftedFile& f) { attributes(f)["JOINTS_0"] = 5; }},
      {"joints_count", "as many as there are positions",
       [](CraftedFile& f) {
         for (const std::size_t a : {4, 5}) f.root["accessors"][a]["count"] = 2;
       }},
      {"joints_index", "accessors", [](CraftedFile& f) { attributes(f)["JOINTS_0"] = 99; }},
      {"nan_weight", "NaN", [=](CraftedFile& f) { set_float(f, 5, 3, nan); }},
      {"negative_weight", "0 or more", [](CraftedFile& f) { set_float(f, 5, 4, -0.5f); }},
      {"skin_index", "skins", [](CraftedFile& f) { f.root["nodes"][0]["skin"] = 1; }},
      {"no_joints", "has no joints", [](CraftedFile& f) { f.root["skins"][0].erase("joints"); }},
      {"zero_joints", "expected 1 to 65535", [](CraftedFile& f) { f.root["skins"][0]["joints"] = json::array(); }},
      {"joint_node", "nodes",
       [](CraftedFile& f) {
         f.root["skins"][0]["joints"] = {4, 12};
       }},
      {"joint_outside", "not in the scene",
       [](CraftedFile& f) {
         f.root["nodes"].push_back(json::object());
         f.root["skins"][0]["joints"] = {4, 7};
       }},
      {"bind_index", "accessors", [](CraftedFile& f) { f.root["skins"][0]["inverseBindMatrices"] = 50; }},
      {"bind_type", "MAT4", [](CraftedFile& f) { f.root["skins"][0]["inverseBindMatrices"] = 5; }},
      {"bind_count", "one a joint", [](CraftedFile& f) { f.root["accessors"][7]["count"] = 1; }},
      {"bind_projective", "0 0 0 1", [](CraftedFile& f) { set_float(f, 7, 19, 0.5f); }},
      {"bind_nan", "NaN", [=](CraftedFile& f) { set_float(f, 7, 20, nan); }},
      {"bind_past_end", "length of its bufferView", [](CraftedFile& f) { f.root["accessors"][7]["count"] = 3; }},
  };
}

std::vector<Recipe> morph_recipes() {
  const float inf = std::numeric_limits<float>::infinity();
  return {
      {"target_count", "as many as there are positions", [](CraftedFile& f) { f.root["accessors"][6]["count"] = 2; }},
      {"target_type", "VEC3",
       [](CraftedFile& f) {
         f.root["meshes"][1]["primitives"][0]["targets"] = {{{"POSITION", 5}}};
       }},
      {"target_index", "accessors",
       [](CraftedFile& f) {
         f.root["meshes"][1]["primitives"][0]["targets"] = {{{"POSITION", -1}}};
       }},
      {"target_infinite", "infinity", [=](CraftedFile& f) { set_float(f, 6, 2, inf); }},
      {"target_far", "at most", [](CraftedFile& f) { set_float(f, 6, 2, 1e30f); }},
      {"targets_differ", "as many in each",
       [](CraftedFile& f) {
         f.root["meshes"][1]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
       }},
      {"mesh_weights", "one a morph target",
       [](CraftedFile& f) {
         f.root["meshes"][1]["weights"] = {0, 1};
       }},
      {"node_weights", "nodes[6]",
       [](CraftedFile& f) {
         f.root["nodes"][6]["weights"] = {0, 1, 2};
       }},
      {"weight_huge", "-1e6 and 1e6", [](CraftedFile& f) { f.root["nodes"][6]["weights"] = {1e30}; }},
  };
}

std::vector<Recipe> animation_recipes() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return {
      {"times_fall", "expected increasing times", [](CraftedFile& f) { set_float(f, 8, 2, 0.25f); }},
      {"times_nan", "NaN", [=](CraftedFile& f) { set_float(f, 8, 1, nan); }},
      {"times_type", "SCALAR", [](CraftedFile& f) { wave(f)["samplers"][0]["input"] = 9; }},
      {"output_count", "expected 3 for 3 keys", [](CraftedFile& f) { f.root["accessors"][9]["count"] = 2; }},
      {"output_type", "VEC4", [](CraftedFile& f) { wave(f)["samplers"][0]["output"] = 0; }},
      {"output_raw_integers", "normalized integers", [](CraftedFile& f) { wave(f)["samplers"][0]["output"] = 4; }},
      {"output_nan", "NaN", [=](CraftedFile& f) { set_float(f, 9, 0, nan); }},
      {"spline_count", "expected 9 for 3 keys",
       [](CraftedFile& f) { wave(f)["samplers"][0]["interpolation"] = "CUBICSPLINE"; }},
      {"interpolation", "'BEZIER'", [](CraftedFile& f) { wave(f)["samplers"][0]["interpolation"] = "BEZIER"; }},
      {"sampler_index", "samplers", [](CraftedFile& f) { wave(f)["channels"][0]["sampler"] = 2; }},
      {"input_index", "accessors", [](CraftedFile& f) { wave(f)["samplers"][1]["input"] = 400; }},
      {"no_output", "has no output", [](CraftedFile& f) { wave(f)["samplers"][1].erase("output"); }},
      {"no_target", "has no target", [](CraftedFile& f) { wave(f)["channels"][1].erase("target"); }},
      {"target_node", "nodes", [](CraftedFile& f) { wave(f)["channels"][1]["target"]["node"] = 7; }},
      {"path_number", "string", [](CraftedFile& f) { wave(f)["channels"][1]["target"]["path"] = 7; }},
      {"no_channels", "has no channels", [](CraftedFile& f) { wave(f).erase("channels"); }},
      {"channels_text", "array", [](CraftedFile& f) { wave(f)["channels"] = "all"; }},
      {"second_time", "a second time",
       [](CraftedFile& f) { wave(f)["channels"].push_back(json(wave(f)["channels"][0])); }},
      {"matrix_moves", "which has a matrix",
       [](CraftedFile& f) { f.root["nodes"][5]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }},
      {"instance_counts", "as many as the others", [](CraftedFile& f) { f.root["accessors"][11]["count"] = 1; }},
      {"instance_type", "VEC4", [](CraftedFile& f) { herd(f)["ROTATION"] = 11; }},
      {"instance_index", "accessors", [](CraftedFile& f) { herd(f)["SCALE"] = 77; }},
      {"instance_nan", "NaN", [=](CraftedFile& f) { set_float(f, 11, 0, nan); }},
      {"instance_far", "expected vertices within", [](CraftedFile& f) { set_float(f, 11, 0, 1e30f); }},
      {"instanced_outline", "outline is instanced",
       [](CraftedFile& f) { f.root["nodes"][6]["extras"]["water"] = true; }},
  };
}

}  // namespace

TEST_CASE("gltf: skins, morph targets, animations and instances are read as the file means them", "[gltf]") {
  const TemporaryFolder folder;
  const Scene scene = load_gltf(moving_file().save_gltf(folder / "moving.gltf"));
  CHECK(scene.warnings.empty());
  REQUIRE(scene.nodes.size() == 9);  // two instances more than in the file
  REQUIRE(scene.locals.size() == 9);
  CHECK(scene.nodes[0].skin == 0);
  REQUIRE(scene.skins.size() == 1);
  CHECK(scene.skins[0].joints == std::vector<std::int32_t>{4, 5});
  CHECK(scene.skins[0].joint_from_mesh[1][3].x == 5);
  CHECK(scene.skins[0].joint_from_mesh[1][3].z == 7);
  const MeshPrimitive& skinned = scene.meshes[0].primitives[0];
  CHECK(skinned.influences == 4);
  // The number of a joint without weight is replaced by 0; weights of sum 2 are halved.
  CHECK(skinned.joints == std::vector<std::uint16_t>{0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0});
  CHECK(skinned.weights == std::vector<float>{1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0});

  CHECK(scene.nodes[6].mesh == kNoIndex);
  for (const std::size_t n : {std::size_t{7}, std::size_t{8}}) {
    CHECK(scene.nodes[n].parent == 6);
    CHECK(scene.nodes[n].mesh == 1);
    CHECK(scene.nodes[n].name == "herd");
    CHECK(scene.nodes[n].morph_weights == std::vector<float>{0.75f});
  }
  CHECK(scene.nodes[8].world_from_local[0].x == -2);  // half a turn about y, twice as large
  CHECK(scene.nodes[8].world_from_local[1].y == 2);
  CHECK(scene.nodes[8].world_from_local[3].y == 5);
  CHECK(scene.meshes[1].primitives[0].flat_normals);
  CHECK_FALSE(skinned.flat_normals);

  REQUIRE(scene.animations.size() == 1);
  REQUIRE(scene.animations[0].channels.size() == 3);  // the weights once an instance
  CHECK(scene.animations[0].channels[0].node == 5);
  CHECK(scene.animations[0].channels[1].node == 7);
  CHECK(scene.animations[0].channels[2].node == 8);
  CHECK(scene.animations[0].channels[2].interpolation == Interpolation::kStep);
  RenderScene render = build_render_scene(scene);
  update_render_scene(render, 0.6);
  CHECK(render.motion.drawables.size() == 3);
}

TEST_CASE("gltf: what moves comes back from a .glb as it was", "[gltf][export]") {
  const TemporaryFolder folder;
  const Scene scene = load_gltf(moving_file().save_gltf(folder / "moving.gltf"));
  export_glb(scene, folder / "written.glb");
  const Scene back = load_gltf(folder / "written.glb");
  CHECK(back.warnings.empty());
  REQUIRE(back.nodes.size() == scene.nodes.size());
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    CAPTURE(n);
    CHECK(back.nodes[n].skin == scene.nodes[n].skin);
    CHECK(back.nodes[n].morph_weights == scene.nodes[n].morph_weights);
    for (int i = 0; i < 4; ++i) CHECK(back.locals[n].rotation[i] == scene.locals[n].rotation[i]);
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 3; ++r) CHECK(back.nodes[n].world_from_local[c][r] == scene.nodes[n].world_from_local[c][r]);
    }
  }
  REQUIRE(back.meshes.size() == 2);
  const MeshPrimitive &a = scene.meshes[0].primitives[0], &b = back.meshes[0].primitives[0];
  CHECK(a.joints == b.joints);
  CHECK(a.weights == b.weights);
  const MeshPrimitive &c = scene.meshes[1].primitives[0], &d = back.meshes[1].primitives[0];
  CHECK(d.flat_normals);
  REQUIRE(d.targets.size() == 1);
  REQUIRE(d.targets[0].positions.size() == c.targets[0].positions.size());
  CHECK(d.targets[0].positions[2].z == c.targets[0].positions[2].z);
  REQUIRE(back.skins.size() == 1);
  CHECK(back.skins[0].name == "bones");
  CHECK(back.skins[0].joint_from_mesh[1][3].y == 6);
  REQUIRE(back.animations.size() == 1);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(back.animations[0].channels[i].values == scene.animations[0].channels[i].values);
    CHECK(back.animations[0].channels[i].times_s == scene.animations[0].channels[i].times_s);
    CHECK(back.animations[0].channels[i].path == scene.animations[0].channels[i].path);
    CHECK(back.animations[0].channels[i].interpolation == scene.animations[0].channels[i].interpolation);
  }
  export_glb(back, folder / "again.glb");
  CHECK(read_whole_file(folder / "written.glb") == read_whole_file(folder / "again.glb"));
}

TEST_CASE("gltf: each invalid skin, morph target, animation and instance is one error that names the fault", "[gltf]") {
  const TemporaryFolder folder;
  for (const auto& recipes : {skin_recipes(), morph_recipes(), animation_recipes()}) {
    for (const Recipe& recipe : recipes) {
      CraftedFile file = moving_file();
      recipe.mutate(file);
      const std::string path = file.save_glb(folder / (std::string(recipe.name) + ".glb"));
      const std::string message = error_of(path);
      CAPTURE(message);
      CHECK_THAT(message, Catch::Matchers::StartsWith(path + ": "));
      CHECK_THAT(message, Catch::Matchers::Contains(recipe.message_part));
      CHECK_THAT(message, Catch::Matchers::Contains("; expected "));
      CHECK(message.find('\n') == std::string::npos);
    }
  }
}

TEST_CASE("gltf: a moving file with any byte changed loads and moves, or is one error", "[gltf]") {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> glb = moving_file().glb();
  int moved = 0, refused = 0;
  for (std::size_t at = 0; at < glb.size(); ++at) {
    std::vector<std::uint8_t> bytes = glb;
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (at % 2 == 0 ? 0x11u : 0xFFu));
    write_file(folder / "changed.glb", bytes);
    try {
      RenderScene render = build_render_scene(load_gltf(folder / "changed.glb"));
      update_render_scene(render, 0.7);
      ++moved;
    } catch (const Error&) {
      ++refused;
    }
  }
  CHECK(moved > 100);
  CHECK(refused > 500);
}

TEST_CASE("gltf: instances and keys count against the limits", "[gltf]") {
  const TemporaryFolder folder;
  const std::string path = moving_file().save_glb(folder / "moving.glb");
  LoadLimits limits;
  limits.max_nodes = 8;
  CHECK_THAT(error_of(path, limits), Catch::Matchers::Contains("nodes and instances"));
  limits = LoadLimits{};
  limits.max_triangles = 2;
  CHECK_THAT(error_of(path, limits), Catch::Matchers::Contains("more than 2 triangles"));
  CraftedFile file = moving_file();
  file.root["accessors"][11] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4000000000u}};
  file.root["nodes"][6]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", 11}};
  CHECK_THAT(error_of(file.save_glb(folder / "many.glb")), Catch::Matchers::Contains("limit of nodes"));
}

TEST_CASE("gltf: what cannot move is named in a warning", "[gltf]") {
  const TemporaryFolder folder;
  const auto warning_of = [&](const std::function<void(CraftedFile&)>& mutate) {
    CraftedFile file = moving_file();
    mutate(file);
    const Scene scene = load_gltf(file.save_glb(folder / "warned.glb"));
    return scene.warnings.empty() ? std::string() : scene.warnings.front();
  };
  CHECK_THAT(warning_of([](CraftedFile& f) { f.root["animations"].push_back(json(wave(f))); }),
             Catch::Matchers::Contains("animations[1] 'wave' not played"));
  CHECK_THAT(warning_of([](CraftedFile& f) { wave(f)["channels"][0]["target"]["path"] = "pointer"; }),
             Catch::Matchers::Contains("'pointer'"));
  CHECK_THAT(warning_of([](CraftedFile& f) { wave(f)["channels"][1]["target"].erase("node"); }),
             Catch::Matchers::Contains("of no node"));
  CHECK_THAT(warning_of([](CraftedFile& f) { f.root["nodes"][6]["skin"] = 0; }),
             Catch::Matchers::Contains("drawn once"));
  CHECK_THAT(warning_of([](CraftedFile& f) {
               attributes(f).erase("JOINTS_0");
               attributes(f).erase("WEIGHTS_0");
             }),
             Catch::Matchers::Contains("without JOINTS_0"));
}

}  // namespace shoal::test
