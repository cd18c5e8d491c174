// Writes a Scene as a .glb file that any glTF viewer opens and that load_gltf reads back unchanged.
#pragma once

#include <cstdio>
#include <string>

#include "scene/scene.h"

namespace shoal {

// Writes a scene. The same scene gives the same bytes.
//
// load_gltf returns every field bit for bit, with three exceptions: Scene::name and warnings; data that nothing refers
// to (a texture that no material uses, the sampler of a material without a texture); and, in a scene without
// animations, the matrix of a node whose parent is not the identity, which is exact where the parent is
// well-conditioned and otherwise correct to double's rounding. 8-bit textures are embedded as PNG, linear ones marked
// by `extras.linear` of the image; float textures are embedded as OpenEXR, which other viewers do not read. Water and
// background are written to `extras`; an environment is not written.
//
//   scene  valid (scene/scene.h), nodes depth first; every primitive with at least one triangle
//   path   written beside its place, then renamed: the file appears whole or stays as it was
//
// Throws Error for a scene that is not valid and for a file that cannot be written; it leaves no partial file.
void export_glb(const Scene& scene, const std::string& path);

// Writes a scene to an open stream. Throws Error where a byte cannot be written.
//   path  begins the message of an Error
void write_glb(const Scene& scene, std::FILE* stream, const std::string& path);

}  // namespace shoal
