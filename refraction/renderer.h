// The library's front door: a scene, settings, and frames out of them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/isa.h"
#include "raster/camera.h"
#include "refraction/data/reflections.h"
#include "refraction/methods/method_info.h"
#include "scene/hit_kind.h"
#include "scene/scene.h"

namespace shoal {

// Shadows of the sun, the first directional light.
enum class Shadows : std::uint8_t { kOff, kMap, kRays };
enum class ToneMap : std::uint8_t { kNone, kAces };

// Every buffer that can be had beside the picture. Names and channels: aov_infos().
enum class Aov : std::uint8_t {
  kDepth,
  kNormal,
  kPosition,
  kIdTriangle,
  kIdNode,
  kVirtual,
  kWaterMask,
  kSurfaceHeight,
  kSurfaceNormal,
  kHitKind,
  kHitPosition,
  kHitId,
  kHitApproximate,
  kHitSecondary,
  kCount
};
struct AovInfo {
  Aov aov;
  const char* name;      // what --aov takes: "depth", "hit.position"
  const char* channels;  // "Z", "XYZ", or "" where the name is the channel's
  bool is_uint;          // uint32, else float
};
const std::vector<AovInfo>& aov_infos();

struct FrameSettings {
  std::string method = "two-phase";
  std::map<std::string, std::string> method_options;  // KEY -> VALUE; an unknown key is a UsageError
  int width_px = 1280, height_px = 720;               // 1 to 16384
  int spp = 1;                                        // 1 to 256
  int threads = 0;                                    // 0: all that the process may use
  int tile_px = 64;                                   // a power of two, 16 to 256
  Isa isa = best_isa();                               // see supported_isas()
  int anisotropy = 1;                                 // 1 (none) to 16
  Shadows shadows = Shadows::kMap;
  int shadow_map_px = 4096;                // a power of two, 256 to 8192
  std::optional<Reflections> reflections;  // none: by the method's category (default_reflections)
  float exposure_stops = 0;
  ToneMap tone_map = ToneMap::kNone;
  std::uint32_t aovs = 0;    // bit 1 << int(Aov)
  bool digests = false;      // compute stage digests
  bool keep_linear = false;  // fill Frame::linear
};

// Rows top to bottom, no padding.
struct AovImage {
  Aov aov;
  int channels = 1;
  std::vector<float> floats;  // interleaved; or
  std::vector<std::uint32_t> uints;
};

struct Frame {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> srgb8;  // RGB, the final 8-bit picture
  std::vector<float> linear;        // RGBA, exposure not applied; A: what the scene covers of the background
  std::vector<AovImage> aovs;       // of the pixels' centres
  std::vector<std::pair<std::string, std::string>> digests;  // stage, hex; in pipeline order
  std::vector<std::pair<std::string, double>> stages_ms;     // in pipeline order
  double frame_ms = 0;
  std::uint64_t water_pixels = 0;
  std::uint64_t subdivision_capped = 0;                        // triangles that reached the subdivision's level cap
  std::vector<std::pair<std::string, double>> method_figures;  // what the method itself reports; mostly nothing
  std::vector<std::pair<std::string, std::uint64_t>> rays;     // traced, by kind; empty where none were
  // Triangles that raster methods fetched from layers, by water pixel, both directions together; of one sample.
  double mean_fetches = 0;
  std::uint32_t max_fetches = 0;
};

// Holds what does not depend on camera and time: meshlets, buffers, threads; of an animated scene a copy of its own,
// which it moves. One frame at a time.
class Renderer {
 public:
  // Throws UsageError for settings out of their domain or an unknown method. The scene must outlive the renderer.
  Renderer(const RenderScene& scene, const FrameSettings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  //   camera  where it is at that time (camera_at)
  //   time_s  seconds; animations and the water's surface move with it
  void render(const Camera& camera, double time_s, Frame& frame);

  int threads() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Digest (hex) of a finished 8-bit picture: what `frame_digests` lists.
std::string picture_digest(const Frame& frame);

// One world point through every stage (shoal probe --point).
struct PointProbe {
  bool refracted = false;  // its path crosses the first body of water
  Vec3f world, virtual_world, crossing_world;
  Vec2f pixel;                // of the virtual position; not finite when it is behind the camera
  float path_m = 0;           // from the eye to the point, along the bent path
  const char* side = "none";  // "air" or "water": where the point is; "none" without water
};
PointProbe probe_point(const RenderScene& scene, const Camera& camera, int width_px, int height_px, Vec3f world);

}  // namespace shoal
