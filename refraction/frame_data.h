// The buffers of one frame, each a named struct, and what a stage's kernel is told.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/blocked_image.h"
#include "raster/bin.h"
#include "raster/camera.h"
#include "raster/cull.h"
#include "raster/fragments.h"
#include "raster/front_end.h"
#include "raster/ray_triangle.h"
#include "raster/setup.h"
#include "raster/visibility.h"
#include "refraction/broad/broad_phase.h"
#include "refraction/field/distance_field.h"
#include "refraction/field/floor.h"
#include "trace/bvh16.h"
#include "raster/pass_bins.h"
#include "refraction/renderer.h"
#include "shading/shadow/shadow_map.h"
#include "trace/ray_queries.h"
#include "scene/scene.h"
#include "water/prepare_surface.h"

namespace shoal {

// What the narrow phase found at a water pixel: the triangle that its refracted (or mirrored) ray shows.
struct HitBuffers {
  AlignedArray<std::int32_t> refracted_id;  // kNoId: the ray leaves the scene; of water: it meets that first
  AlignedArray<std::int32_t> mirrored_id;   // written where WaterPass::mirrors
  AlignedArray<float> aim_x, aim_y, aim_z;  // world: where, by methods that know it; else empty
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
  AlignedArray<std::int32_t> outside;  // 1: the method looked for it outside of the frame
};

// Linear light, blocked, the average over samples when the last one is in.
struct LitBuffer {
  AlignedArray<float> red, green, blue, alpha;
};

// Light and world position by pixel: the refracted layer as it is lit, and what water pixels took from it. Empty unless
// the method shades before.
struct LitPoints {
  AlignedArray<float> red, green, blue;           // linear
  AlignedArray<float> x_world, y_world, z_world;  // of the point; 0 where there is none
  AlignedArray<std::int32_t> outside;             // of what pixels took: 1 where they looked outside of the frame
  void resize(const FrameGrid& g) {
    for (auto* plane : {&red, &green, &blue, &x_world, &y_world, &z_world}) plane->resize(g.pixel_slots());
    outside.resize(g.pixel_slots());
  }
};

// What is seen through, laid over what is behind it: colour = light + keep * behind, at each sample of a block that has
// any; the other blocks' planes hold nothing.
struct BlendLayer {
  AlignedArray<float> red, green, blue;  // linear light that the fragments send to the eye, the nearer ones' share off
  AlignedArray<float> keep;              // what they let through, 1 to 0
  AlignedArray<std::uint8_t> filled;     // [blocks] 1: the block's planes are set
  void resize(const FrameGrid& g) {
    for (auto* plane : {&red, &green, &blue, &keep}) plane->resize(g.pixel_slots());
    filled.resize(g.block_count());
  }
};

// Blended materials (refraction/passes/blend.h).
struct Blended {
  std::vector<std::uint32_t> meshlets;  // of the scene, in submission order
  PassBins bins;                      // of one pass at a time, over `meshlets`
  BinGrid grid;                       // tiles are the 64-pixel regions, whatever the frame's own tiles are
  std::vector<FragmentLists> lists;   // [threads]
  BlendLayer direct;                  // in front of what the direct pass shows
  BlendLayer refracted, mirrored;     // on water pixels' rays beyond the surface, and back from it
  bool any() const { return !meshlets.empty(); }
};

// The grid of the refracted and the mirrored layer: the frame's, or, where the method looks along bent rays into the
// lit layer, with a margin all round. Margins are whole regions, so a frame's block is a block of the layer.
struct LayerGrid {
  FrameGrid grid;
  BinGrid tiles, regions;
  int margin_px = 0;
  std::size_t offset(int x_px, int y_px) const {  // of the block at a pixel of the frame
    return grid.block_offset((x_px + margin_px) >> 2, (y_px + margin_px) >> 2);
  }
  std::size_t region(const FrameGrid& frame, std::size_t of_frame) const {
    const std::size_t margin = static_cast<std::size_t>(margin_px / kRegionSize),
                      across = static_cast<std::size_t>(frame.regions_x);
    return (of_frame / across + margin) * static_cast<std::size_t>(grid.regions_x) + of_frame % across + margin;
  }
};
inline constexpr int kWaveMargin_px = 64;

// One warped pass over the scene for a body of water: refracted, or mirrored.
struct WaterPass {
  const WaterBody* body = nullptr;
  const WaterSurface* surface = nullptr;  // at this time; null where it is flat
  std::int32_t index = 0;                 // of the body
  BroadPhase optics;                      // the body's plane with its true index
  BroadPhase map;                         // the map that geometry is drawn with: the method's choice
  Plane keep;                             // world clip plane: what the pass draws
  Frustum frustum;                        // of the region's bounds
  PassSettings pass;
  float near_m = 0;                // of the camera: displaced water that is nearer is not met
  RayDifferential<float> pixel{};  // of the camera's rays
  bool mirrored = false;           // this is the mirrored pass of the two
  bool looks_far = false;          // the narrow phase may look anywhere in the frame
  bool mirrors = false;            // the surface shows the scene on the eye's own side, not the background alone
};

// Does the surface mirror the scene on the side that a ray comes from, whatever --reflections says? It does from within
// the water, and from the denser side (ior below 1), where reflection can be total (docs/decisions).
SHOAL_INLINE bool always_mirrors(bool from_below, float eta) { return from_below || eta > 1.0f; }

// Rays that a frame followed, all samples together.
struct RayCounts {
  enum Kind { kPrimary, kReflected, kRefracted, kShadow, kKinds };
  std::uint64_t of[kKinds] = {};
};

inline constexpr std::size_t kMaxMethodOptions = 16;

// Everything that a kernel may read or write in a frame. The renderer owns it and keeps its memory between frames.
struct FrameData {
  // Fixed for a renderer.
  const RenderScene* scene = nullptr;
  FrameSettings settings;
  FrameGrid grid;
  BinGrid bin_grid;
  LayerGrid layers;
  GeometryView geometry;
  GeometryView water_geometry;                     // the outlines of the bodies of water
  SunShadows shadows;                              // of the sun, which stands still as the scene does
  std::unique_ptr<RayQueries> rays;                // where the method or the shadows trace rays, else null
  std::unique_ptr<Bvh16> tree;              // over the scene, where there is water, else null
  std::unique_ptr<DistanceFields> fields;          // of the method that has them, else null
  std::vector<Floor> floors;                       // of the bodies, for the method that knows nothing else
  float method_option[kMaxMethodOptions] = {};     // of the method, in the order of its list
  std::vector<std::uint32_t> outline_first_meshlet;  // of body b; one more at the end
  std::vector<SurfaceModel> surface_models;        // of the bodies

  // This frame.
  double time_s = 0;
  std::vector<WaterSurface> surfaces;  // of the bodies, at this time
  View view;                           // of this sample
  Frustum frustum;
  PassSettings direct_pass;
  int sample = 0, sample_count = 1;
  bool capture = false;    // fill gbuffer and hit points (the sample at the pixel's centre)
  bool accumulate = true;  // this sample enters the picture
  bool last_sample = true;
  std::int32_t eye_in_water = -1;  // body that the eye is in, or -1

  PassBins bins;
  PassBins water_bins;
  Blended blended;
  VisibilityBuffer direct, refracted, mirrored;
  std::vector<std::uint8_t> region_of_body;  // [regions] 64-pixel cells that show this pass's body, or touch such
  std::vector<std::uint8_t> layer_regions;   // [layers' regions] that are drawn
  std::vector<std::uint8_t> tile_active;     // [layers' tiles] that those touch
  std::vector<WaterPass> water;              // one a body, whether it shows or not
  LitPoints layer;                           // the refracted layer, before absorption
  LitPoints fetched;  // what each water pixel took from it, absorbed; the points only where they are captured
  HitBuffers hits;
  HitPoints hit_points;
  GBuffer gbuffer;
  LitBuffer lit;
  std::vector<std::uint8_t> srgb8;  // RGB rows
  std::uint64_t water_pixels = 0;
  std::uint64_t subdivision_capped = 0;
  mutable RayCounts ray_counts;  // kernels that only read the frame count too
};

}  // namespace shoal
