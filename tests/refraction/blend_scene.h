// Scenes of unlit triangles, each with a colour and an alpha of its own.
#pragma once

#include <string>
#include <vector>

#include "refraction/renderer.h"

namespace shoal_test {

using namespace shoal;

// One material and its triangles.
struct Sheet {
  std::vector<Vec3f> corners;  // three a triangle
  Vec4f color{1, 1, 1, 1};
  bool blended = true, two_sided = true;
};

inline Sheet quad(Vec3f a, Vec3f b, Vec3f c, Vec3f d, Vec4f color, bool blended = true) {
  return {{a, b, c, a, c, d}, color, blended, true};
}

// Triangle ids count up through the sheets in their order.
inline Scene scene_of(const std::vector<Sheet>& sheets, Vec3f background) {
  Scene scene;
  scene.name = "sheets";
  for (const Sheet& sheet : sheets) {
    Material m;
    m.base_color = sheet.color;
    m.unlit = true;
    m.double_sided = sheet.two_sided;
    m.alpha_mode = sheet.blended ? AlphaMode::kBlend : AlphaMode::kOpaque;
    MeshPrimitive p;
    p.positions = sheet.corners;
    p.normals.assign(sheet.corners.size(), Vec3f{0, 0, 1});
    for (std::uint32_t i = 0; i < sheet.corners.size(); ++i) p.indices.push_back(i);
    p.material = static_cast<std::int32_t>(scene.materials.materials.size());
    scene.materials.materials.push_back(m);
    Node node;
    node.mesh = static_cast<std::int32_t>(scene.meshes.size());
    scene.meshes.push_back({"sheet", {p}});
    scene.nodes.push_back(node);
  }
  scene.has_background = true;
  scene.background.color = background;
  return scene;
}

inline Frame render_scene(const RenderScene& scene, const Camera& camera, const FrameSettings& settings) {
  Frame frame;
  Renderer(scene, settings).render(camera, 0, frame);
  return frame;
}

}  // namespace shoal_test
