// The pixel functions of raster/, sixteen pixels at a time, one copy an ISA.
#include "bench/kernels.h"
#include "raster/resolve.h"
#include "shading/light.h"
#include "shading/material_uv.h"
#include "shading/post.h"
#include "shading/sky.h"
#include "shading/surface.h"

namespace shoal::bench::inline SHOAL_ISA_NS {

namespace {

// Calls store(block, surface, lanes) with the surface points of each block of a region, as shade_hits finds them.
// It prefetches a block's lines of the ids and of the targets one row of blocks before they are needed: rows lie pages
// apart, where the processor does not prefetch by itself, and stores that wait for their lines hold up all that
// follows.
//   ahead  called with the first slot of the block below each one
template <class Store, class Ahead>
SHOAL_INLINE void surfaces_of_region(const VisibleIn& in, std::size_t region, Store store, Ahead ahead) {
  const RayDifferential<WideF> differential = pixel_ray_differential<WideF>(in.view);
  const std::size_t row = static_cast<std::size_t>(in.direct.grid.blocks_x) * kBlockPixels;
  for_each_block(in.direct.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    if (const std::size_t below = block.offset + row; below < in.direct.id.size()) {
      __builtin_prefetch(in.direct.id.data() + below);
      ahead(below);
    }
    const WideI id = WideI::load(in.direct.id.data() + block.offset);
    const WideM shown = is_triangle(id) & block.in_frame;
    if (none(shown)) return;
    const Ray<WideF> ray = block_rays(in.view, block);
    PixelAttributes<WideF> a;
    resolve_attributes(in.shading.geometry, ray, differential, id, shown, a);
    const Vec3<WideF> to_eye = -normalize(ray.direction_world);
    for_each_distinct(a.material, shown, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
      store(block,
            make_surface<WideF>(in.shading.materials[one], in.shading.textures, a.position_world, a.normal_world, a.uv,
                                a.duv_dx, a.duv_dy, a.color, to_eye, lanes),
            lanes);
    });
  });
}

SHOAL_INLINE void put(AlignedArray<float>* planes, std::size_t at, const Vec3<WideF>& v, WideM lanes) {
  store_masked(planes[0].data() + at, v.x, lanes);
  store_masked(planes[1].data() + at, v.y, lanes);
  store_masked(planes[2].data() + at, v.z, lanes);
}

void fill_float(const VisibleIn& in, FloatTargets& to, std::size_t region) {
  surfaces_of_region(
      in, region,
      [&](const Block& block, const SurfaceSample<WideF>& s, WideM lanes) SHOAL_LAMBDA {
        put(to.position, block.offset, s.position_world, lanes);
        put(to.normal, block.offset, s.normal_world, lanes);
        put(to.color, block.offset, s.base_color, lanes);
      },
      [&](std::size_t below) SHOAL_LAMBDA {
        const AlignedArray<float>* targets[] = {to.position, to.normal, to.color};
        for (const AlignedArray<float>* planes : targets)
          for (int c = 0; c < 3; ++c) __builtin_prefetch(planes[c].data() + below, 1);
      });
}

SHOAL_INLINE WideI unorm8(WideF v) { return to_int_nearest(clamp(v, WideF(0.0f), WideF(1.0f)) * WideF(255.0f)); }
SHOAL_INLINE WideI pack(WideI x, WideI y, WideI z) { return x | (y << 8) | (z << 16); }

void fill_rgba8(const VisibleIn& in, Rgba8Targets& to, std::size_t region) {
  surfaces_of_region(
      in, region,
      [&](const Block& block, const SurfaceSample<WideF>& s, WideM lanes) SHOAL_LAMBDA {
        const WideF half(0.5f);
        const Vec3<WideF>& n = s.normal_world;
        const WideI normal = pack(unorm8(n.x * half + half), unorm8(n.y * half + half), unorm8(n.z * half + half));
        const WideI color =
            pack(encode_srgb8(s.base_color.x), encode_srgb8(s.base_color.y), encode_srgb8(s.base_color.z));
        const WideI material = pack(unorm8(s.metallic), unorm8(s.roughness), unorm8(s.alpha));
        store_masked(to.normal.data() + block.offset, normal, lanes);
        store_masked(to.color.data() + block.offset, color, lanes);
        store_masked(to.material.data() + block.offset, material, lanes);
      },
      [&](std::size_t below) SHOAL_LAMBDA {
        __builtin_prefetch(to.normal.data() + below, 1);
        __builtin_prefetch(to.color.data() + below, 1);
        __builtin_prefetch(to.material.data() + below, 1);
      });
}

void resolve(const GeometryView& g, const View& view, const std::int32_t* ids, std::size_t blocks, float* out) {
  const RayDifferential<WideF> differential = pixel_ray_differential<WideF>(view);
  const Ray<WideF> ray = pixel_ray(view, WideF(400.5f) + to_float(block_x()), WideF(400.5f) + to_float(block_y()));
  WideF sum(0.0f);
  for (std::size_t b = 0; b < blocks; ++b) {
    PixelAttributes<WideF> a;
    resolve_attributes(g, ray, differential, WideI::load(ids + b * 16), mask_from_bits(0xFFFFu), a);
    sum = sum + a.t;
  }
  sum.store(out);
}

void sample_row(const Texture& texture, const Sampler& sampler, float uv_step, float spread, std::size_t blocks,
                float* out) {
  const WideM odd = (lane_index() & WideI(1)) != WideI(0);
  const WideF step = select(odd, WideF(uv_step * spread), WideF(uv_step)), zero(0.0f);
  WideF sum(0.0f);
  for (std::size_t b = 0; b < blocks; ++b) {
    const WideF x = to_float(WideI(static_cast<std::int32_t>(b) * 4) + block_x());
    const Vec2<WideF> uv{x * WideF(uv_step), to_float(block_y()) * WideF(uv_step)};
    const Vec4<WideF> texel = sample<WideF>(texture, sampler, uv, {step, zero}, {zero, step}, mask_from_bits(0xFFFFu));
    sum = sum + ((texel.x + texel.y) + texel.z);
  }
  sum.store(out);
}

void shade_blocks(const GBufferBlock* in, const Lighting& lighting, std::size_t blocks, float* out) {
  const Vec3<WideF> to_eye = broadcast<WideF>(Vec3f{0.6f, 0.8f, 0.0f}), one = broadcast<WideF>(Vec3f{1, 1, 1});
  for (std::size_t b = 0; b < blocks; ++b, out += 48) {
    const Vec3<WideF> c = shade<WideF>(load_surface(in[b]), mask_from_bits(0), to_eye, lighting, one);
    c.x.store(out), c.y.store(out + 16), c.z.store(out + 32);
  }
}

void sky(const Background& background, const float* directions, std::size_t blocks, float* out) {
  for (std::size_t b = 0; b < blocks; ++b, directions += 48, out += 48) {
    const Vec3<WideF> d{WideF::load(directions), WideF::load(directions + 16), WideF::load(directions + 32)};
    const Vec3<WideF> c = background_radiance<WideF>(background, d);
    c.x.store(out), c.y.store(out + 16), c.z.store(out + 32);
  }
}

void encode(const float* linear, bool aces, std::size_t blocks, std::uint8_t* out) {
  const PostSettings post{0.0f, aces ? ToneCurve::kAces : ToneCurve::kNone};
  for (std::size_t b = 0; b < blocks; ++b, linear += 48, out += 48) {
    const Vec3<WideF> light{WideF::load(linear), WideF::load(linear + 16), WideF::load(linear + 32)};
    const Vec3<WideF> c = tone_map<WideF>(light, post, 1.0f);
    store_rgb8_block(out, 12, encode_srgb8(c.x), encode_srgb8(c.y), encode_srgb8(c.z));
  }
}

}  // namespace

}  // namespace shoal::bench::inline SHOAL_ISA_NS

namespace shoal::bench {
const RasterKernels& SHOAL_THIS_ISA(raster_kernels)() {
  static constexpr RasterKernels table{
      .fill_float = &fill_float,
      .fill_rgba8 = &fill_rgba8,
      .resolve = &resolve,
      .sample = &sample_row,
      .shade = &shade_blocks,
      .sky = &sky,
      .encode = &encode,
  };
  return table;
}
}  // namespace shoal::bench
