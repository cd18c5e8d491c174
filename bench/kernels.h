// Kernels that a suite calls by themselves. kernels_<suite>.isa.cpp is compiled once an ISA and fills one table an ISA.
#pragma once

#include <cstddef>
#include <cstdint>

#include "bench/gbuffer_block.h"
#include "bench/solvers/path_solvers.h"
#include "core/isa_dispatch.h"
#include "raster/visibility.h"
#include "refraction/broad/broad_phase.h"
#include "shading/light.h"
#include "shading/shading_view.h"
#include "trace/bvh16.h"

namespace shoal::bench {

// A function of one value, over an array: `count` is a multiple of 16.
struct MathKernel {
  const char* name;
  float lo, hi;  // the domain that it is measured over
  void (*run)(const float* in, float* out, std::size_t count);
};
struct CoreKernels {
  const MathKernel* math;
  std::size_t math_count;
};
SHOAL_ISA_TABLE(CoreKernels, core_kernels)

// Three full-frame targets in 4 x 4 blocks; depth is the visibility buffer's.
struct FloatTargets {
  AlignedArray<float> position[3], normal[3], color[3];
};
struct Rgba8Targets {
  AlignedArray<std::int32_t> normal, color, material;
};

// What shows the surfaces of a frame: visible ids, and what they refer to.
struct VisibleIn {
  const ShadingView& shading;
  const View& view;
  const VisibilityBuffer& direct;
};

struct RasterKernels {
  // Visible ids of one 64-pixel region to three targets: what the frame's resolve does, and stores.
  void (*fill_float)(const VisibleIn&, FloatTargets&, std::size_t region);
  void (*fill_rgba8)(const VisibleIn&, Rgba8Targets&, std::size_t region);
  // Sixteen ids a block to attributes; the sum of their depths goes to out, sixteen floats.
  void (*resolve)(const GeometryView&, const View&, const std::int32_t* ids, std::size_t blocks, float* out);
  // A row of blocks along u, uv_step apart by pixel; spread scales the derivatives of every other pixel.
  void (*sample)(const Texture&, const Sampler&, float uv_step, float spread, std::size_t blocks, float* out);
  void (*shade)(const GBufferBlock*, const Lighting&, std::size_t blocks, float* out);
  // Planes of x, y, z (unit) to planes of r, g, b; sixteen a block.
  void (*sky)(const Background&, const float* directions, std::size_t blocks, float* out);
  // Planes of linear r, g, b to RGB bytes; aces: with the tone curve.
  void (*encode)(const float* linear, bool aces, std::size_t blocks, std::uint8_t* out);
};
SHOAL_ISA_TABLE(RasterKernels, raster_kernels)

enum class PathWay { kFixedPoint, kNewton, kHalley, kQuartic, kTable };

// Points are planes of x, y, z, `count` (a multiple of 16) floats each.
struct RefractionKernels {
  void (*virtual_distance)(const BroadPhase&, const float* far_m, const float* across_m, std::size_t count, float* out);
  // The same by another solver (bench/solvers/path_solvers.h).
  void (*solve)(const BroadPhase&, PathWay way, int steps, const PathTable&, const float* far_m, const float* across_m,
                std::size_t count, float* out);
  void (*virtual_position)(const BroadPhase&, const float* points, std::size_t count, float* out);
  void (*edge_deviation)(const BroadPhase&, const View&, const float* a, const float* b, std::size_t count, float* out);
  // View rays of one 64-pixel region to their refracted and reflected rays and differentials.
  void (*exact_ray)(const BroadPhase&, const View&, const FrameGrid&, std::size_t region, float* out);
  // confirm_hit of view rays against the visibility buffer; by_neighbours: as if no pixel had a triangle of its own.
  void (*confirm)(const VisibleIn&, bool by_neighbours, std::size_t region, std::int32_t* out);
};
SHOAL_ISA_TABLE(RefractionKernels, refraction_kernels)

// Sixteen rays, and what they hit first.
struct alignas(64) RayBlock {
  float origin_world[3][16], direction_world[3][16];  // unit directions
  float t_far[16];
};
struct alignas(64) HitsOfBlock {
  std::int32_t id[16];
  float t[16];
};

struct TraceKernels {
  void (*nearest)(const Bvh16&, const ShadingView&, const RayBlock&, HitsOfBlock& out);
  // The same by one traversal for each ray.
  void (*each)(const Bvh16&, const ShadingView&, const RayBlock&, HitsOfBlock& out);
  std::uint32_t (*blocked)(const Bvh16&, const ShadingView&, const RayBlock&);  // a bit a ray
};
SHOAL_ISA_TABLE(TraceKernels, trace_kernels)

}  // namespace shoal::bench
