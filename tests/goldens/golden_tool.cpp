// Draws the goldens of a group in one process and compares them with the committed digests and pictures.
//
//   golden_tool --groups   names the groups, one a line
//   golden_tool --frames   names every frame: GROUP NAME METHOD ARGUMENT..., the arguments those of `shoal render`
//   golden_tool GROUP      compares; a line for each frame that differs, exit 1 where there is one
//   golden_tool GROUP --changed  names the frames that differ instead, GROUP NAME METHOD ARGUMENT...; exit 0
//
// It runs in the root of the sources. A frame that differs leaves NAME.actual.png, NAME.expected.png,
// NAME.difference.png and its digests NAME.txt in out/goldens/. A scene is loaded once and a renderer made once for all
// the views of it, so a golden also shows that a renderer's second frame is that of a new one.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/isa.h"
#include "refraction/renderer.h"
#include "scene/images/images.h"
#include "tests/goldens/golden_list.h"

namespace {

namespace fs = std::filesystem;
using goldens::Group;
using goldens::View;
using shoal::Error;
using Digests = std::vector<std::pair<std::string, std::string>>;

const fs::path kGoldens = "tests/goldens", kOut = "out/goldens";

struct Rgba {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

Rgba rgba_of(const shoal::Frame& frame) {
  Rgba picture{frame.width_px, frame.height_px, {}};
  for (std::size_t i = 0; i < frame.srgb8.size(); ++i) {
    picture.bytes.push_back(frame.srgb8[i]);
    if (i % 3 == 2) picture.bytes.push_back(255);
  }
  return picture;
}

Rgba read_png(const fs::path& path) {
  const shoal::Texture texture = shoal::load_texture(path.string(), true);
  return {texture.width[0], texture.height[0], shoal::texture_bytes(texture)};
}

void write_png(const fs::path& path, const Rgba& picture) {
  const shoal::Texture texture = shoal::make_texture_rgba8(picture.width, picture.height, picture.bytes.data(), true);
  const std::vector<std::uint8_t> file = shoal::encode_texture(texture, path.string());
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
  if (!out.flush()) throw Error(path.string() + ": cannot be written; expected room for a picture");
}

// What `shoal render --digest` prints.
std::string text_of(const Digests& digests) {
  std::string text;
  for (const auto& [stage, hex] : digests) text += "digest " + stage + " " + hex + "\n";
  return text;
}

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// In the pipeline's order: the first of the frame's stages that the golden has otherwise or not at all, else the first
// that only the golden has.
std::string first_stage(const std::string& expected, const Digests& actual) {
  for (const auto& [stage, hex] : actual) {
    if (("\n" + expected).find("\ndigest " + stage + " " + hex + "\n") == std::string::npos) return stage;
  }
  std::istringstream lines(expected);
  for (std::string word, stage, hex; lines >> word >> stage >> hex;) {
    const auto same = [&, &name = stage](const auto& digest) { return digest.first == name; };
    if (std::none_of(actual.begin(), actual.end(), same)) return stage;
  }
  return "none";
}

// The first pixel that differs, as text; empty where none does.
std::string first_pixel(const Rgba& expected, const Rgba& actual) {
  if (expected.width != actual.width || expected.height != actual.height) return "another size";
  for (std::size_t i = 0; i < actual.bytes.size(); ++i) {
    if (expected.bytes[i] == actual.bytes[i]) continue;
    const std::size_t pixel = i / 4, width = static_cast<std::size_t>(actual.width);
    return "first " + std::to_string(pixel % width) + "," + std::to_string(pixel / width) + " " + "RGBA"[i % 4] + ": " +
           std::to_string(expected.bytes[i]) + " and " + std::to_string(actual.bytes[i]);
  }
  return "";
}

// Absolute differences of the colours; black where only one of the pictures is.
Rgba difference_of(const Rgba& expected, const Rgba& actual) {
  Rgba picture = actual;
  const bool comparable = expected.bytes.size() == actual.bytes.size();
  for (std::size_t i = 0; i < picture.bytes.size(); ++i) {
    const int difference = comparable ? std::abs(int{expected.bytes[i]} - int{actual.bytes[i]}) : 0;
    picture.bytes[i] = i % 4 == 3 ? std::uint8_t{255} : static_cast<std::uint8_t>(difference);
  }
  return picture;
}

std::string frame_line(const Group& group, const View& view, const std::string& method) {
  return group.name + " " + view.golden(method) + " " + method + " " + view.arguments + "\n";
}

class Check {
 public:
  Check(const Group& group, bool lists_changed) : group_(group), lists_changed_(lists_changed) {}

  // All frames of the group; then exit code 0 or 1.
  int run() {
    fs::create_directories(kOut);
    std::vector<char> done(group_.views.size(), 0);
    for (std::size_t i = 0; i < group_.views.size(); ++i) {
      if (done[i]) continue;
      // The views of one scene together.
      std::vector<const View*> views;
      for (std::size_t k = i; k < group_.views.size(); ++k) {
        if (!same_scene(group_.views[i], group_.views[k])) continue;
        views.push_back(&group_.views[k]);
        done[k] = 1;
      }
      draw(views);
    }
    if (compared_ == 0) complain("group " + group_.name + ": no frame was drawn");
    std::printf("%s%s: %d frames, %d differ\n", lists_changed_ ? "# " : "", group_.name.c_str(), compared_, differ_);
    return differ_ > 0 && !lists_changed_ ? 1 : 0;
  }

 private:
  static bool same_scene(const View& a, const View& b) {
    return std::tie(a.scene, a.water, a.methods, a.width_px, a.height_px) ==
           std::tie(b.scene, b.water, b.methods, b.width_px, b.height_px);
  }

  void complain(const std::string& what) {
    ++differ_;
    if (!lists_changed_) std::printf("%s\n", what.c_str());
  }

  void draw(const std::vector<const View*>& views) {
    const std::shared_ptr<const shoal::RenderScene> kept = goldens::load_scene(*views.front());
    const shoal::RenderScene& scene = *kept;
    for (const std::string& method : views.front()->methods) {
      shoal::FrameSettings settings;
      settings.method = method;
      settings.width_px = views.front()->width_px;
      settings.height_px = views.front()->height_px;
      settings.isa = shoal::supported_isas().front();
      settings.digests = true;
      if (views.front()->traced_shadows) settings.shadows = shoal::Shadows::kRays;
      std::unique_ptr<shoal::Renderer> renderer;
      try {
        renderer = std::make_unique<shoal::Renderer>(scene, settings);
      } catch (const shoal::NotApplicable&) {
        for (const View* view : views) refuse_golden(*view, method);
        continue;
      }
      for (const View* view : views) {
        shoal::Frame frame;
        renderer->render(camera_of(scene, *view), view->time_s, frame);
        compare(*view, method, frame);
      }
    }
  }

  static shoal::Camera camera_of(const shoal::RenderScene& scene, const View& view) {
    for (const shoal::PlacedCamera& placed : scene.cameras) {
      if (placed.name == view.camera) return shoal::camera_at(scene, placed, view.time_s);
    }
    throw Error(view.scene + ": has no camera " + view.camera + "; expected that of the golden " + view.name);
  }

  // A method that is not made for a scene has no golden of it.
  void refuse_golden(const View& view, const std::string& method) {
    const std::string name = view.golden(method);
    if (fs::exists(kGoldens / (name + ".txt")) || fs::exists(kGoldens / (name + ".png"))) {
      complain(name + ": belongs to no scene, camera or method: " + method + " is not applicable");
      if (lists_changed_) std::printf("removed %s\n", name.c_str());
    }
  }

  void compare(const View& view, const std::string& method, const shoal::Frame& frame) {
    ++compared_;
    const std::string name = view.golden(method);
    for (const char* ending : {".txt", ".actual.png", ".expected.png", ".difference.png"}) {
      fs::remove(kOut / (name + ending));
    }
    const fs::path digests = kGoldens / (name + ".txt"), picture = kGoldens / (name + ".png");
    const bool known = fs::exists(digests) && fs::exists(picture);
    const std::string expected_text = read_text(digests), actual_text = text_of(frame.digests);
    const Rgba expected = known ? read_png(picture) : Rgba{}, actual = rgba_of(frame);
    const std::string pixel = first_pixel(expected, actual);
    if (known && expected_text == actual_text && pixel.empty()) return;

    std::ofstream(kOut / (name + ".txt")) << actual_text;
    write_png(kOut / (name + ".actual.png"), actual);
    if (lists_changed_) std::printf("%s", frame_line(group_, view, method).c_str());
    if (!known) {
      complain(name + ": there is no such golden; look at " + (kOut / name).string() +
               ".actual.png, then scripts/update_goldens --reason TEXT");
      return;
    }
    fs::copy_file(picture, kOut / (name + ".expected.png"), fs::copy_options::overwrite_existing);
    write_png(kOut / (name + ".difference.png"), difference_of(expected, actual));
    complain(name + ": first stage that differs: " + first_stage(expected_text, frame.digests) + "; pixel: " +
             (pixel.empty() ? "none of the picture" : pixel) + "; see " + (kOut / name).string() + ".*.png");
  }

  const Group& group_;
  bool lists_changed_;
  int compared_ = 0, differ_ = 0;
};

int run(const std::vector<std::string>& arguments) {
  const std::string folder = kGoldens.string();
  const bool changed = arguments.size() == 2 && arguments[1] == "--changed";
  if (arguments.size() != 1 && !changed) throw shoal::UsageError("expected --groups, --frames or GROUP [--changed]");
  if (arguments[0] != "--groups" && arguments[0] != "--frames") {
    const Group group = goldens::make_group(folder, arguments[0]);
    return Check(group, changed).run();
  }
  for (const std::string& name : goldens::group_names(folder)) {
    if (arguments[0] == "--groups") {
      std::printf("%s\n", name.c_str());
      continue;
    }
    const Group group = goldens::make_group(folder, name);
    for (const View& view : group.views) {
      for (const std::string& method : view.methods) std::printf("%s", frame_line(group, view, method).c_str());
    }
  }
  return 0;
}

}  // namespace

int main(int count, char** texts) {
  try {
    return run(std::vector<std::string>(texts + 1, texts + count));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "golden_tool: error: %s\n", error.what());
    return 1;
  }
}
