// Which frames have goldens.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace goldens {

// What one camera of a scene sees at one time, and the methods that draw it.
struct View {
  std::string name;             // of its goldens
  bool name_has_method = true;  // NAME_METHOD is the golden; else NAME is
  std::string scene;            // a built-in scene, or a file's path from the root of the sources
  std::string camera;           // its name
  double time_s = 0;
  std::vector<std::string> water;  // KEY=VALUE of the water's surface, as `shoal render --set` takes them
  bool traced_shadows = false;     // --shadows rays
  int width_px = 160, height_px = 90;
  std::vector<std::string> methods;
  std::string arguments;  // of `shoal render`: everything but the method

  std::string golden(const std::string& method) const { return name_has_method ? name + "_" + method : name; }
};

// Goldens that one process draws.
struct Group {
  std::string name;
  std::vector<View> views;
};

// Triangles of the built-in scenes.
inline constexpr std::uint64_t kTriangles = 2000;

// The groups: `box` and `pool`, the first word of each line of water.list, and `assets`.
//   folder  the one with the lists
// Throws shoal::Error where a list cannot be read.
std::vector<std::string> group_names(const std::string& folder);

// A group's views: a scene by all its cameras or as a line of water.list says, each by every method of the
// registry; or the lines of assets.list by the default method. Throws shoal::Error for a name of no group.
Group make_group(const std::string& folder, const std::string& name);

// Reads or makes the scene of a view, with the view's water; the one that was loaded last is kept.
std::shared_ptr<const shoal::RenderScene> load_scene(const View& view);

}  // namespace goldens
