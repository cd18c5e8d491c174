// Any bytes as a glTF file: loaded, built, moved; or refused with one line.
#include <cmath>

#include "core/error.h"
#include "scene/gltf/gltf.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

// Files that a scene may name lie beside it.
const TemporaryFolder& folder() {
  static const TemporaryFolder made;
  static const bool filled = [] {
    write_file(made / "data.bin", std::vector<std::uint8_t>(256, 0x3F));
    write_file(made / "image.png", png(2, 2, 6, 8, std::vector<std::uint8_t>(16, 0x80)));
    return true;
  }();
  (void)filled;
  return made;
}

LoadLimits tight_limits() {
  LoadLimits limits;
  limits.max_file_bytes = 1 << 20;
  limits.max_json_bytes = 1 << 20;
  limits.max_nodes = 1 << 10;
  limits.max_triangles = 1 << 13;
  limits.max_scene_bytes = 16 << 20;
  limits.max_unbacked_elements = 1 << 12;
  limits.max_texture_size = 256;
  limits.max_texels = 1 << 14;
  return limits;
}

bool finite(Vec3f v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_texture(const Materials& materials, std::int32_t texture) {
  promise(texture == kNoTexture || (texture >= 0 && static_cast<std::size_t>(texture) < materials.textures.size()),
          "a material has a texture that is not there");
}

void check_consistent(const RenderScene& scene) {
  const Geometry& g = scene.geometry;
  for (const VertexRecord& v : g.vertices) {
    promise(finite(v.position_world) && finite(v.normal_world), "a vertex is not finite");
    promise(std::fabs(dot(v.normal_world, v.normal_world) - 1) < 1e-2f, "a normal is not of unit length");
  }
  for (const Vec4f t : g.tangents) promise(finite({t.x, t.y, t.z}), "a tangent is not finite");
  for (const Geometry::TriangleRecord& t : g.triangles) {
    for (const std::uint32_t v : t.vertex) promise(v < g.vertices.size(), "a triangle has a vertex that is not there");
    promise(t.material < scene.materials.materials.size(), "a triangle has a material that is not there");
  }
  for (const Meshlet& m : g.meshlets) {
    for (std::size_t i = m.first_index; i < m.first_index + std::size_t{m.triangle_count}; ++i) {
      promise(g.corner0[i] < m.vertex_count && g.corner1[i] < m.vertex_count && g.corner2[i] < m.vertex_count,
              "a meshlet's corner is not among its vertices");
    }
    promise(finite(m.bounds_min_world) && finite(m.bounds_max_world), "a meshlet's bounds are not finite");
  }
  for (const Material& m : scene.materials.materials) {
    check_texture(scene.materials, m.base_color_texture);
    for (const MaterialMap* map : {&m.metallic_roughness, &m.normal, &m.occlusion, &m.emission}) {
      check_texture(scene.materials, map->texture);
    }
  }
  for (const WaterBody& body : scene.waters) {
    promise(finite(body.origin) && finite(body.normal), "a body of water has no plane");
    promise(!body.outline.empty() && body.outline.size() % 3 == 0, "a body of water has no outline");
    promise(std::isfinite(body.depth_m), "a body of water has no depth");
  }
  promise(!scene.cameras.empty(), "there is no camera");
  for (const PlacedCamera& placed : scene.cameras) {
    promise(finite(placed.camera.position_world) && finite(placed.camera.forward_world), "a camera is not finite");
  }
}

}  // namespace

std::string outcome_of(std::span<const std::uint8_t> bytes) {
  const std::string path = folder() / "scene.glb";  // which container it is, its bytes say
  write_file(path, std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
  try {
    const Scene scene = load_gltf(path, tight_limits());
    for (const std::string& warning : scene.warnings) {
      promise(warning.find('\n') == std::string::npos, "a warning of several lines");
    }
    RenderScene render = build_render_scene(scene);
    check_consistent(render);
    for (const double time_s : {0.3, 1e6}) {
      update_render_scene(render, time_s);
      check_consistent(render);
    }
  } catch (const Error& error) {
    const std::string message = error.what();
    promise(is_one_line(message) && message.rfind(path + ": ", 0) == 0, "an error is not one line about the file");
    return message;
  }
  return "loaded";
}

}  // namespace shoal::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  shoal::test::outcome_of({data, size});
  return 0;
}
