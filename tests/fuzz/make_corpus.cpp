// Writes the fuzzers' seeds: make_fuzz_corpus FOLDER. Small files, between them of every kind that the readers know.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <filesystem>

#include "scene/images/images.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

template <class T>
std::size_t add(CraftedFile& file, const std::vector<T>& values, int component_type, const char* type,
                std::size_t components, bool normalized = false) {
  return file.add_accessor(values.data(), values.size() * sizeof(T), component_type, type, values.size() / components,
                           normalized);
}

json triangle_of(std::size_t positions) { return {{"attributes", {{"POSITION", positions}}}}; }

std::size_t add_triangle(CraftedFile& file) { return file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3); }

// Every component type an attribute may have.
CraftedFile component_types() {
  CraftedFile file = empty_file();
  file.root["extensionsRequired"] = file.root["extensionsUsed"] = {"KHR_mesh_quantization"};
  const std::vector<std::int8_t> b = {0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0};
  const std::vector<std::uint8_t> ub = {0, 0, 0, 255, 255, 0, 0, 255, 0, 255, 0, 255};
  const std::vector<std::int16_t> s = {0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0};
  const std::vector<std::uint16_t> us = {0, 0, 0, 65535, 65535, 0, 0, 65535, 0, 65535, 0, 65535};
  const std::vector<std::uint8_t> corners8 = {0, 1, 2, 0};
  const std::vector<std::uint16_t> corners16 = {0, 1, 2};
  const std::vector<std::uint32_t> corners32 = {2, 1, 0};
  // Three elements of three or two components at a stride of four or eight bytes.
  const auto strided = [&](const void* data, std::size_t size, std::size_t stride, int component_type, const char* type,
                           bool normalized) {
    file.root["accessors"].push_back({{"bufferView", file.add_view(data, size, stride)},
                                      {"componentType", component_type},
                                      {"type", type},
                                      {"count", 3},
                                      {"normalized", normalized}});
    return file.root["accessors"].size() - 1;
  };
  const std::size_t p0 = strided(b.data(), b.size(), 4, 5120, "VEC3", false);
  const std::size_t p1 = strided(ub.data(), ub.size(), 4, 5121, "VEC3", true);
  const std::size_t p2 = strided(s.data(), 24, 8, 5122, "VEC3", true);
  const std::size_t p3 = strided(us.data(), 24, 8, 5123, "VEC3", false);
  const std::size_t p4 = add_triangle(file);
  const std::size_t uv8 = strided(ub.data(), ub.size(), 4, 5121, "VEC2", true);
  const std::size_t uv16 = add<std::uint16_t>(file, {0, 0, 65535, 0, 0, 65535}, 5123, "VEC2", 2, true);
  const std::size_t c8 = add(file, ub, 5121, "VEC4", 4, true);
  const std::size_t c16 = add(file, us, 5123, "VEC4", 4, true);
  const std::size_t cf = file.add_floats({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 3);
  const std::size_t n8 = strided(b.data(), b.size(), 4, 5120, "VEC3", true);
  const std::size_t t8 =
      add<std::int8_t>(file, {127, 0, 0, 127, 127, 0, 0, 127, 127, 0, 0, -127}, 5120, "VEC4", 4, true);
  const std::size_t i8 = file.add_accessor(corners8.data(), 3, 5121, "SCALAR", 3);
  const std::size_t i16 = add(file, corners16, 5123, "SCALAR", 1), i32 = add(file, corners32, 5125, "SCALAR", 1);
  file.add_mesh({{"attributes", {{"POSITION", p0}, {"TEXCOORD_0", uv8}, {"COLOR_0", c8}}}, {"indices", i8}});
  file.add_mesh({{"attributes", {{"POSITION", p1}, {"TEXCOORD_0", uv16}, {"COLOR_0", c16}}}, {"indices", i16}});
  file.add_mesh(
      {{"attributes", {{"POSITION", p2}, {"NORMAL", n8}, {"TANGENT", t8}, {"COLOR_0", cf}}}, {"indices", i32}});
  file.add_mesh(triangle_of(p3));
  file.add_mesh(triangle_of(p4));
  return file;
}

CraftedFile sparse_accessors() {
  CraftedFile file = empty_file();
  const std::size_t full = file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3", 3);
  const std::vector<float> moved = {0, 2, 0, 2, 2, 0};
  const std::size_t values = file.add_view(moved.data(), 24);
  for (const int type : {5121, 5123, 5125}) {
    const std::uint32_t wide[] = {2, 3};
    const std::uint16_t half[] = {2, 3};
    const std::uint8_t narrow[] = {2, 3};
    const void* data = type == 5125   ? static_cast<const void*>(wide)
                       : type == 5123 ? half
                                      : static_cast<const void*>(narrow);
    const std::size_t size = type == 5125 ? 8u : type == 5123 ? 4u : 2u;
    const json sparse = {{"count", 2},
                         {"indices", {{"bufferView", file.add_view(data, size)}, {"componentType", type}}},
                         {"values", {{"bufferView", values}}}};
    json accessor = {{"componentType", 5126}, {"type", "VEC3"}, {"count", type == 5121 ? 6 : 4}, {"sparse", sparse}};
    if (type != 5121) accessor["bufferView"] = file.root["accessors"][full]["bufferView"];
    file.root["accessors"].push_back(accessor);
  }
  const std::uint16_t corners[] = {0, 1, 2, 3};
  const std::size_t strip = file.add_accessor(corners, sizeof corners, 5123, "SCALAR", 4);
  file.add_mesh(triangle_of(full + 1));
  for (const int mode : {0, 1, 2, 3, 5, 6}) {
    json primitive = triangle_of(full + 2);
    primitive["mode"] = mode;
    primitive["indices"] = strip;
    file.add_mesh(primitive);
  }
  json morphed = triangle_of(full);
  morphed["mode"] = 5;
  morphed["targets"] = {{{"POSITION", full + 3}}};
  file.root["meshes"][file.add_mesh(morphed)]["weights"] = {0.5};
  return file;
}

// Skin, morph targets, instances, and animations of each interpolation and path.
CraftedFile moving() {
  CraftedFile file = good_file();
  json& root = file.root;
  const std::size_t joints = add<std::uint8_t>(file, {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, 5121, "VEC4", 4);
  const std::size_t weights = file.add_floats({1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  const std::size_t shift = file.add_floats({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3", 3);
  const std::size_t bind = file.add_floats(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 1, 1}, "MAT4", 16);
  const std::size_t times = file.add_floats({0, 0.5f, 2}, "SCALAR", 1);
  const std::size_t turns =
      add<std::int16_t>(file, {0, 0, 0, 32767, 0, 32767, 0, 0, 0, 0, 32767, 0}, 5122, "VEC4", 4, true);
  const std::size_t amounts = add<std::uint8_t>(file, {0, 255, 64}, 5121, "SCALAR", 1, true);
  const std::size_t moves = file.add_floats(std::vector<float>(27, 0.25f), "VEC3", 3);
  const std::size_t places = file.add_floats({1, 2, 3, 4, 5, 6}, "VEC3", 3);
  const std::size_t facing = add<std::int8_t>(file, {0, 0, 0, 127, 0, 127, 0, 0}, 5120, "VEC4", 4, true);
  const std::size_t scales = file.add_floats({1, 1, 1, 2, -2, 2}, "VEC3", 3);
  json& primitive = root["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] = joints;
  primitive["attributes"]["WEIGHTS_0"] = weights;
  json morphed = triangle_of(0);
  morphed["attributes"]["NORMAL"] = 1;
  morphed["targets"] = {{{"POSITION", shift}, {"NORMAL", shift}}};
  root["meshes"].push_back({{"primitives", {morphed}}, {"weights", {0.75}}});
  root["skins"] = json::array({json{{"joints", {4, 5}}, {"inverseBindMatrices", bind}, {"skeleton", 4}}});
  root["nodes"][0]["skin"] = 0;
  root["nodes"].push_back({{"children", {5, 1, 2, 3}}, {"translation", {1, 0, 0}}});
  root["nodes"].push_back({{"name", "tip"}});
  const json attributes = {{"TRANSLATION", places}, {"ROTATION", facing}, {"SCALE", scales}};
  root["nodes"].push_back({{"mesh", 1}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
  root["scenes"][0]["nodes"] = {0, 4, 6};
  root["extensionsUsed"].push_back("EXT_mesh_gpu_instancing");
  const auto sampler = [&](std::size_t output, const char* how) {
    return json{{"input", times}, {"output", output}, {"interpolation", how}};
  };
  const auto channel = [](std::size_t s, std::size_t node, const char* path) {
    return json{{"sampler", s}, {"target", {{"node", node}, {"path", path}}}};
  };
  root["animations"] = {
      {{"samplers", {sampler(turns, "LINEAR"), sampler(amounts, "STEP"), sampler(moves, "CUBICSPLINE")}},
       {"channels",
        {channel(0, 5, "rotation"), channel(1, 6, "weights"), channel(2, 4, "translation"), channel(2, 5, "scale")}}}};
  return file;
}

Bytes jpeg(int width, int height, int channels) {
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput sink(file);
  const OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  Bytes texels(static_cast<std::size_t>(width * height * channels));
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<std::uint8_t>(i * 37);
  const auto out = OIIO::ImageOutput::create("image.jpg");
  if (!out || !out->set_ioproxy(&sink) || !out->open("memory", spec) ||
      !out->write_image(OIIO::TypeDesc::UINT8, texels.data()) || !out->close()) {
    return {};
  }
  return file;
}

// All maps of a material, as PNG and JPEG, in a view, a data URI (by save_gltf's buffer) and a file of its own.
CraftedFile textured() {
  CraftedFile file = good_file();
  json& root = file.root;
  const Bytes picture = jpeg(8, 8, 3);
  root["images"].push_back({{"bufferView", file.add_view(picture.data(), picture.size())}, {"mimeType", "image/jpeg"}});
  root["images"].push_back({{"uri", "image.png"}});
  root["images"].push_back({{"uri",
                             "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAAEElEQVR4AQEFAPr/"
                             "AAECAwQAHAAPSXVKXQAAAABJRU5E"
                             "rkJggg=="}});
  for (int i = 1; i < 4; ++i) root["textures"].push_back({{"source", i}});
  root["samplers"].push_back({{"magFilter", 9728}, {"minFilter", 9987}, {"wrapS", 33648}, {"wrapT", 10497}});
  root["textures"][1]["sampler"] = 1;
  const json transform = {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}, {"rotation", 0.5}, {"scale", {2, -1}}}}};
  root["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}, {"extensions", transform}}},
         {"metallicRoughnessTexture", {{"index", 1}}},
         {"baseColorFactor", {1, 0.5, 0.25, 0.5}},
         {"metallicFactor", 0.5},
         {"roughnessFactor", 0.5}}},
       {"normalTexture", {{"index", 1}, {"scale", 2}, {"texCoord", 1}}},
       {"occlusionTexture", {{"index", 2}, {"strength", 0.5}}},
       {"emissiveTexture", {{"index", 0}}},
       {"emissiveFactor", {1, 1, 1}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.25},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_ior", {{"ior", 1.33}}}, {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}},
      {{"extensions", {{"KHR_materials_unlit", json::object()}}}, {"alphaMode", "BLEND"}}};
  root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = 2;
  json second = root["meshes"][0]["primitives"][0];
  second["material"] = 1;
  root["meshes"][0]["primitives"].push_back(second);
  root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_unlit", "KHR_texture_transform", "KHR_materials_ior",
                            "KHR_materials_emissive_strength"};
  return file;
}

CraftedFile lights_cameras_water() {
  CraftedFile file = good_file();
  json& root = file.root;
  root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"color", {1, 0.5, 0.25}}, {"intensity", 3}},
      {{"type", "point"}, {"range", 4}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}}};
  root["cameras"].push_back(
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 2}, {"znear", 0}, {"zfar", 10}}}});
  const auto light = [](int i) { return json{{"KHR_lights_punctual", {{"light", i}}}}; };
  root["nodes"].push_back({{"extensions", light(1)}, {"matrix", {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 2, 3, 1}}});
  root["nodes"].push_back({{"extensions", light(2)}, {"rotation", {0.5, 0.5, 0.5, 0.5}}, {"scale", {1, -2, 1}}});
  root["nodes"].push_back({{"camera", 1}});
  root["nodes"].push_back({{"extras", {{"water_size", {2, 2}}, {"water_depth", 1.5}, {"water_ior", 1.4}}}});
  root["nodes"].push_back({{"mesh", 1}, {"extras", {{"water", true}, {"water_absorption", {0.1, 0.2, 0.3}}}}});
  const std::size_t flat = file.add_floats({0, 0, 0, 0, 0, 1, 1, 0, 0}, "VEC3", 3);
  root["meshes"].push_back({{"primitives", {triangle_of(flat)}}});
  root["nodes"][3]["extras"]["water"]["surface"] = {{"type", "gerstner"}, {"amplitude", 0.1}, {"seed", 3}};
  root["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  root["scenes"][0]["extras"] = {{"background", {{"type", "sky"}, {"zenith", {0, 0, 1}}, {"to_sun", {0, 1, 0}}}}};
  root["asset"]["extras"] = {{"background", {0.5, 0.5, 0.5}}};
  root["scenes"].push_back({{"nodes", {0}}});
  return file;
}

// The header and what follows it, taken apart and put together again.
Bytes png_with_header(const Bytes& file, const Bytes& header, const Bytes& palette) {
  Bytes out(file.begin(), file.begin() + 8);
  append_png_chunk(out, "IHDR", header);
  if (!palette.empty()) append_png_chunk(out, "PLTE", palette);
  out.insert(out.end(), file.begin() + 33, file.end());
  return out;
}

void write_images(const std::string& folder) {
  const auto save = [&](const char* name, const Bytes& bytes) { write_file(folder + "/" + name, bytes); };
  save("grey.png", png(2, 2, 0, 8, {0, 100, 200, 255}));
  save("grey_alpha.png", png(1, 2, 4, 8, {77, 5, 78, 6}));
  save("rgb.png", png(2, 1, 2, 8, {1, 2, 3, 4, 5, 6}));
  save("rgba.png", png(2, 1, 6, 8, {1, 2, 3, 4, 5, 6, 7, 8}));
  save("grey16.png", png(2, 1, 0, 16, {0, 1, 255, 254}));
  save("rgba16.png", png(1, 1, 6, 16, {0, 1, 2, 3, 4, 5, 6, 7}));
  save("palette.png",
       png_with_header(png(2, 1, 3, 8, {0, 1}), {0, 0, 0, 2, 0, 0, 0, 1, 8, 3, 0, 0, 0}, {9, 8, 7, 1, 2, 3}));
  save("one_bit.png", png(8, 2, 0, 1, {0xAA, 0x55}));
  // The seven passes of 4 x 4 texels have 23 bytes.
  save("interlaced.png", png_with_header(png(22, 1, 0, 8, Bytes(22, 0)), {0, 0, 0, 4, 0, 0, 0, 4, 8, 0, 0, 0, 1}, {}));
  save("grey.jpg", jpeg(9, 7, 1));
  save("rgb.jpg", jpeg(16, 8, 3));
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n";
  Bytes hdr(header.begin(), header.end());
  for (int i = 0; i < 4; ++i) hdr.insert(hdr.end(), {128, 64, 32, 129});
  save("flat.hdr", hdr);
  const std::string runs = "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
  Bytes rle(runs.begin(), runs.end());
  rle.insert(rle.end(), {2, 2, 0, 8, 136, 1, 136, 2, 4, 3, 4, 5, 6, 132, 7, 136, 129});
  save("runs.hdr", rle);
  std::vector<float> light(16 * 4, 0.5f);
  light[3] = 1e6f;
  save("light.exr", encode_texture(make_texture_float(4, 4, light.data()), "light.exr"));
}

void write_scenes(const std::string& folder) {
  const auto save = [&](const std::string& name, const CraftedFile& file) {
    file.save_glb(folder + "/" + name + ".glb");
    file.save_gltf(folder + "/" + name + ".gltf");
  };
  save("good", good_file());
  save("components", component_types());
  save("sparse", sparse_accessors());
  save("moving", moving());
  save("textured", textured());
  save("lights_cameras_water", lights_cameras_water());
  CraftedFile outside = good_file();
  outside.root["buffers"][0] = {{"uri", "data.bin"}, {"byteLength", 256}};
  outside.root["images"][0] = {{"uri", "image.png"}};
  outside.root["meshes"][0]["primitives"][0].erase("indices");
  outside.root["accessors"][3] = outside.root["accessors"][2];
  outside.save_gltf(folder + "/outside.gltf");
}

}  // namespace
}  // namespace shoal::test

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_fuzz_corpus FOLDER\n", stderr);
    return 2;
  }
  const std::string folder = argv[1];
  std::filesystem::create_directories(folder + "/gltf");
  std::filesystem::create_directories(folder + "/image");
  shoal::test::write_scenes(folder + "/gltf");
  shoal::test::write_images(folder + "/image");
  return 0;
}
