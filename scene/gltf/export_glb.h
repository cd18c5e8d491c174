// A Scene as a .glb file that any glTF viewer opens and load_gltf reads back identical.
#pragma once

#include <cstdio>
#include <string>

#include "scene/scene.h"

namespace shoal {

// Writes a scene. The same scene gives the same bytes.
//
// load_gltf gives back every field bit for bit, apart from: Scene::name and warnings; what nothing refers to (a texture
// that no material uses, the sampler of a material without texture); and, of a scene without animations, the matrix of
// a node whose parent is not the identity, which is exact where the parent is well-conditioned and else right to
// double's rounding. 8-bit textures are embedded as PNG; linear ones are marked by `extras.linear` of the image, float
// ones are OpenEXR, which other viewers do not read. Water and background go to `extras`, an environment does not.
//
//   scene  valid (scene/scene.h), nodes depth first; every primitive with at least one triangle
//   path   appears whole (written beside, then renamed) or stays as it was
//
// Throws Error for a scene that is not valid and for a file that cannot be written; nothing is left behind.
void export_glb(const Scene& scene, const std::string& path);

// The same into an open stream, for callers with files of their own. Throws Error where a byte cannot be written;
// `path` is for its message only.
void write_glb(const Scene& scene, std::FILE* stream, const std::string& path);

}  // namespace shoal
