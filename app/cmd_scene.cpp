// shoal scene: writes a built-in procedural scene as a .glb.
#include <fmt/format.h>

#include "app/commands.h"
#include "app/load.h"
#include "app/output.h"
#include "core/error.h"
#include "scene/gltf/export_glb.h"

namespace shoal::app {

int run_scene(const RawOptions& raw) {
  const SceneOptions options = read_scene_options(raw);
  if (has_ending(options.name, ".gltf") || has_ending(options.name, ".glb")) {
    throw UsageError(fmt::format("scene '{}': is a file; expected a built-in scene (shoal list scenes)", options.name));
  }
  if (!raw.output || !has_ending(*raw.output, ".glb")) {
    throw UsageError(fmt::format("-o '{}': not a scene file's name; expected FILE.glb", raw.output.value_or("")));
  }
  check_writable(*raw.output);
  const Scene scene = read_scene(options.name, options.triangles);
  OutputFile file(*raw.output);
  write_glb(scene, file.stream(), *raw.output);
  file.finish();
  file.commit();
  return 0;
}

}  // namespace shoal::app
