// The buffers of one frame, each a named struct, and what a stage's kernel is told.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/blocked_image.h"
#include "raster/bin.h"
#include "raster/camera.h"
#include "raster/cull.h"
#include "raster/front_end.h"
#include "raster/setup.h"
#include "raster/visibility.h"
#include "refraction/broad/broad_phase.h"
#include "refraction/renderer.h"
#include "refraction/shadow_map.h"
#include "scene/scene.h"

namespace shoal {

// What the narrow phase found at a water pixel: the triangle that its refracted (or mirrored) ray shows.
struct HitBuffers {
  AlignedArray<std::int32_t> refracted_id;  // kNoId: the ray leaves the scene
  AlignedArray<std::int32_t> mirrored_id;   // written where the surface mirrors the scene (mirrors_scene)
  void resize(const FrameGrid& g) {
    refracted_id.resize(g.pixel_slots());
    mirrored_id.resize(g.pixel_slots());
  }
};

// Planes of one float a pixel, blocked: what digests and AOVs want to see of the pixel stages. Empty unless asked for.
struct GBuffer {
  enum Plane {
    kPositionX,
    kPositionY,
    kPositionZ,
    kNormalX,
    kNormalY,
    kNormalZ,
    kColorR,
    kColorG,
    kColorB,
    kMetallic,
    kRoughness,
    kPlaneCount
  };
  AlignedArray<float> plane[kPlaneCount];
};
struct HitPoints {
  AlignedArray<float> x_world, y_world, z_world;
  AlignedArray<float> virtual_x, virtual_y, virtual_z;
  AlignedArray<std::int32_t> kind;
  AlignedArray<std::int32_t> id;
};

// Linear light, blocked, the average over samples when the last one is in.
struct LitBuffer {
  AlignedArray<float> red, green, blue, alpha;
};

// Bins of one pass: one item a run of chunks.
struct PassBins {
  std::vector<BinItem> items;
  std::uint32_t chunks_per_item = 1;
  std::uint32_t chunk_count = 0;
};

// One warped pass over the scene for a body of water: refracted, or mirrored.
struct WaterPass {
  const WaterBody* body = nullptr;
  std::int32_t index = 0;  // of the body
  BroadPhase optics;       // the body's plane with its true index
  BroadPhase map;          // the map that geometry is drawn with: the method's choice
  Plane keep;              // world clip plane: what the pass draws
  Frustum frustum;         // of the region's bounds
  PassSettings pass;
};

// Does the surface mirror the scene on the eye's own side? It does to an eye in the water, and to one on the denser
// side (ior below 1), where reflection can be total; elsewhere it reflects the background (docs/decisions).
SHOAL_INLINE bool mirrors_scene(const BroadPhase& optics) {
  return optics.eye_below || (!optics.eye_is_thin && !optics.path.identity);
}

// Everything that a kernel may read or write in a frame. The renderer owns it and keeps its memory between frames.
struct FrameData {
  // Fixed for a renderer.
  const RenderScene* scene = nullptr;
  FrameSettings settings;
  FrameGrid grid;
  BinGrid bin_grid;
  GeometryView geometry;
  GeometryView water_geometry;                     // the outlines of the bodies of water
  SunShadows shadows;                              // of the sun, which stands still as the scene does
  std::vector<std::uint32_t> outline_first_chunk;  // of body b; one more at the end

  // This frame.
  View view;  // of this sample
  Frustum frustum;
  PassSettings direct_pass;
  int sample = 0, sample_count = 1;
  bool capture = false;    // fill gbuffer and hit points (the sample at the pixel's centre)
  bool accumulate = true;  // this sample enters the picture
  bool last_sample = true;
  std::int32_t eye_in_water = -1;  // body that the eye is in, or -1

  PassBins bins;
  PassBins water_bins;
  VisibilityBuffer direct, refracted, mirrored;
  std::vector<std::uint8_t> region_of_body;  // [regions] this pass's region, 64-pixel cells
  std::vector<std::uint8_t> tile_active;     // [tiles] tiles that the region touches
  std::vector<WaterPass> water;              // one a body, whether it shows or not
  HitBuffers hits;
  HitPoints hit_points;
  GBuffer gbuffer;
  LitBuffer lit;
  std::vector<std::uint8_t> srgb8;  // RGB rows
  std::uint64_t water_pixels = 0;
  std::uint64_t subdivision_capped = 0;
};

}  // namespace shoal
