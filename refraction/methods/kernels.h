// The kernels of a frame behind function pointers: one table an instruction set, and one an instruction set and method.
// The stages themselves, with their inputs and outputs, are in refraction/passes/ and refraction/narrow/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/isa.h"
#include "refraction/data/category.h"
#include "refraction/data/options.h"
#include "refraction/narrow/layer_edges.h"
#include "refraction/narrow/scene_hits.h"
#include "refraction/passes/blend_pass.h"
#include "refraction/passes/direct_pass.h"
#include "refraction/passes/displaced_water.h"
#include "refraction/passes/interface_pass.h"
#include "refraction/passes/layer_from_hits.h"
#include "refraction/passes/layer_pass.h"
#include "refraction/passes/lit_layer.h"
#include "refraction/passes/shade_pass.h"
#include "refraction/passes/shade_water.h"
#include "refraction/passes/tile_pass.h"
#include "refraction/passes/trace_pass.h"
#include "shading/shadow/shadow_pass.h"

namespace shoal {

class ThreadPool;

// The stages that are the same for every method, in the order of a frame.
struct FrameKernels {
  ShadowKernels shadow;
  decltype(ShadowRays::blocked) sun_blocked;  // traced shadows
  void (*outline_front_end)(const OutlinePassIn&, const BinsOut&);
  void (*direct_front_end)(const DirectPassIn&, const BinsOut&, std::size_t work_item);
  void (*draw_tile)(const TilePassIn&, VisibilityBuffer&, std::size_t tile);
  void (*draw_tile_behind)(const TilePassIn&, const VisibilityBuffer& nearest, VisibilityBuffer&, std::size_t tile);
  void (*find_edges)(const VisibilityBuffer&, const std::int32_t* drawn, EdgeMap&, std::size_t region);
  AlphaTestFunction direct_alpha_test, refracted_alpha_test, reflected_alpha_test;
  void (*draw_tile_over)(const TilePassIn&, const VisibilityBuffer& under, VisibilityBuffer&, std::size_t tile);
  void (*draw_displaced_water)(const DisplacedWaterIn&, VisibilityBuffer&, std::size_t region);
  WaterCount (*count_water)(const VisibilityBuffer& direct, std::int32_t body, std::size_t region);
  void (*refracted_front_end)(const LayerPassIn&, const BinsOut&, std::size_t work_item);
  void (*reflected_front_end)(const LayerPassIn&, const BinsOut&, std::size_t work_item);
  void (*blended_front_end)(const BlendedPassIn&, const BinsOut&, std::size_t work_item);
  void (*find_interface)(const InterfaceIn&, const InterfaceOut&, std::size_t region);
  void (*reflected_hits)(const ReflectedHitsIn&, HitBlock* hits, std::size_t region);
  void (*layer_from_hits)(const LayerFromHitsIn&, VisibilityBuffer&, std::size_t region);
  void (*blend_water)(const BlendWaterIn&, const BlendOut&, std::size_t region);
  void (*trace_secondary_interfaces)(const SecondaryIn&, const SecondaryOut&, std::size_t region);
  void (*shade_water)(const ShadeWaterIn&, const ShadeWaterOut&, std::size_t region);
  void (*blend_direct)(const BlendDirectIn&, const BlendOut&, std::size_t region);
  void (*shade)(const ShadeIn&, const ShadeOut&, std::size_t region);
};

// The scene and, in an animated scene, the camera that a method prepares for.
struct PrepareIn {
  const RenderScene& scene;
  const Camera* camera;  // null where nothing moves
  ThreadPool& pool;
};

// What a method brings (refraction/methods/method.h makes it of the method's struct).
struct MethodKernels {
  // The map that the refracted layer is drawn with.
  BroadPhase (*map)(const WaterBody&, const View&) = nullptr;
  bool draws_layer = true;     // false: the method finds hits by itself, and no refracted layer is drawn
  bool follows_waves = false;  // its rays follow the waves' normals: the layer of flat water is not valid under waves
  bool lights_layer = false;   // an image-space method: the layer is lit, and the narrow phase fetches from it
  bool traces = false;         // its rays may be traced against the BVH
  bool searches = false;       // it searches the layers along bent rays: they are drawn under waves too, and widened
  bool whole_scene = false;    // the layer is the frame without its water, drawn once for the direct pass too
  bool misses = false;         // the method may find nothing where there is something
  PixelRaysFunction rays = nullptr;           // refracted rays: of the layer's alpha test and of blended materials
  PixelRaysFunction shown_rays = nullptr;     // refracted rays that the pixels show
  PixelRaysFunction own_reflected = nullptr;  // reflected rays, where they are not the surface's
  // One region's water pixels: HybridNarrowIn holds the inputs of every category, and the method's function receives
  // those of its own (refraction/data/category.h).
  void (*narrow)(const HybridNarrowIn&, const NarrowOut&, std::size_t region) = nullptr;
  // The same of the reflected rays, by the planar reflection layer.
  void (*planar)(const PlanarIn&, const NarrowOut&, std::size_t region) = nullptr;
  // Are the second layers searched? null: no.
  bool (*searches_behind)(const MethodState&) = nullptr;
  // The layer's front ends by a map of the method's own; null: by `map`.
  void (*refracted_front_end)(const LayerPassIn&, const BinsOut&, std::size_t work_item) = nullptr;
  void (*blended_front_end)(const BlendedPassIn&, const BinsOut&, std::size_t work_item) = nullptr;
  // Makes the method's private data: once where nothing moves, else in every frame. Throws NotApplicable where the
  // method cannot show the scene.
  void (*prepare)(const PrepareIn&, MethodState&) = nullptr;
  // A traced method: one region of the frame by rays alone. The stages above are then not used.
  void (*trace)(const TraceIn&, const TraceOut&, std::size_t region) = nullptr;
};

// Is the refracted layer of a body drawn?
inline bool draws_refracted_layer(const MethodKernels& method, const WaterOptics& optics) {
  return method.draws_layer && (method.searches || visibility_layer_valid(method.follows_waves, optics));
}

struct Method {
  const char* name;
  MethodCategory category;
  const char* description;
  const char* source;
  MethodKernels kernels;
  OptionList options = {};
};

// Throws UsageError for an unknown name.
const Method& find_method(const std::string& name, Isa isa);
const FrameKernels& frame_kernels(Isa isa);

}  // namespace shoal
