#include "refraction/aov.h"

#include <limits>

#include "raster/camera.h"
#include "water/displaced_surface.h"

namespace shoal {

namespace {

constexpr std::uint32_t kNoneOut = 0xFFFFFFFFu;

// One pixel's place in the blocked buffers, and what it shows.
struct Pixel {
  std::size_t slot;
  std::int32_t id;
  bool water() const { return id < 0; }
  bool triangle() const { return id >= 0 && id != kNoId; }
};

std::uint32_t id_out(std::int32_t id) { return id >= 0 && id != kNoId ? static_cast<std::uint32_t>(id) : kNoneOut; }

// Node of a triangle: its drawable is the last that starts at or before it.
std::uint32_t node_of(const Geometry& g, std::int32_t id) {
  std::size_t lo = 0, hi = g.drawables.size();
  while (hi - lo > 1) {
    const std::size_t mid = (lo + hi) / 2;
    (g.drawables[mid].first_triangle <= static_cast<std::uint32_t>(id) ? lo : hi) = mid;
  }
  return g.drawables[lo].node;
}

// Metres along the view axis; infinity where nothing is.
float depth_m(const FrameData& f, const Pixel& p) {
  if (p.id == kNoId) return std::numeric_limits<float>::infinity();
  return view_depth_m(f.view, f.direct.depth[p.slot]);
}

class Planes {
 public:
  Planes(const AlignedArray<float>& x, const AlignedArray<float>& y, const AlignedArray<float>& z)
      : plane_{&x, &y, &z} {}
  Vec3f at(std::size_t slot) const { return {(*plane_[0])[slot], (*plane_[1])[slot], (*plane_[2])[slot]}; }

 private:
  const AlignedArray<float>* plane_[3];
};

// The surface of a body over a point of it.
struct Waves {
  float height_m;
  Vec3f normal;  // on the plane normal's side
};
Waves waves_at(const FrameData& f, const Pixel& p, Vec3f position_world) {
  const WaterPass& water = f.water[static_cast<std::size_t>(p.id - kFirstWaterId)];
  const WaterBody& body = *water.body;
  if (water.surface == nullptr) return {0.0f, body.normal};
  const Vec3f at = on_body<float>(body, position_world);
  return {surface_at<float>(*water.surface, at.x, at.z).height_m,
          displaced_normal<float>(body, *water.surface, position_world)};
}

Vec3f vector_at(const FrameData& f, Aov aov, const Pixel& p) {
  const AlignedArray<float>* g = f.gbuffer.plane;
  const HitPoints& h = f.hit_points;
  const Planes position(g[GBuffer::kPositionX], g[GBuffer::kPositionY], g[GBuffer::kPositionZ]);
  const Planes normal(g[GBuffer::kNormalX], g[GBuffer::kNormalY], g[GBuffer::kNormalZ]);
  switch (aov) {
    case Aov::kPosition:
      return position.at(p.slot);
    case Aov::kNormal:
      return normal.at(p.slot);
    case Aov::kHitPosition:
      return Planes(h.x_world, h.y_world, h.z_world).at(p.slot);
    case Aov::kVirtual:
      return p.water() ? Planes(h.virtual_x, h.virtual_y, h.virtual_z).at(p.slot) : position.at(p.slot);
    case Aov::kSurfaceNormal:
      return p.water() ? waves_at(f, p, position.at(p.slot)).normal : Vec3f{0, 0, 0};
    default:
      return {0, 0, 0};
  }
}

float surface_height_m(const FrameData& f, const Pixel& p) {
  if (!p.water()) return 0.0f;
  const AlignedArray<float>* g = f.gbuffer.plane;
  return waves_at(f, p, Planes(g[GBuffer::kPositionX], g[GBuffer::kPositionY], g[GBuffer::kPositionZ]).at(p.slot))
      .height_m;
}

std::uint32_t uint_at(const FrameData& f, const RenderScene& scene, Aov aov, const Pixel& p) {
  switch (aov) {
    case Aov::kIdTriangle:
      return id_out(p.id);
    case Aov::kIdNode:
      if (p.triangle()) return node_of(scene.geometry, p.id);
      return p.water() ? scene.waters[static_cast<std::size_t>(p.id - kFirstWaterId)].node : kNoneOut;
    case Aov::kWaterMask:
      return p.water() ? static_cast<std::uint32_t>(p.id - kFirstWaterId) + 1u : 0u;
    case Aov::kHitKind:
      return static_cast<std::uint32_t>(f.hit_points.kind[p.slot]);
    case Aov::kHitOutside:
      return static_cast<std::uint32_t>(f.hit_points.outside[p.slot]);
    case Aov::kHitId:
      return id_out(f.hit_points.id[p.slot]);
    default:
      return 0;
  }
}

template <class Body>
void for_each_pixel(const FrameData& f, Body body) {
  for (int y = 0; y < f.grid.height_px; ++y)
    for (int x = 0; x < f.grid.width_px; ++x) {
      const std::size_t slot = f.grid.slot(x, y);
      body(Pixel{slot, f.direct.id[slot]});
    }
}

}  // namespace

const std::vector<AovInfo>& aov_infos() {
  static const std::vector<AovInfo> infos = {
      {Aov::kDepth, "depth", "Z", false},
      {Aov::kNormal, "normal", "XYZ", false},
      {Aov::kPosition, "position", "XYZ", false},
      {Aov::kIdTriangle, "id.triangle", "", true},
      {Aov::kIdNode, "id.node", "", true},
      {Aov::kVirtual, "virtual", "XYZ", false},
      {Aov::kWaterMask, "water.mask", "", true},
      {Aov::kSurfaceHeight, "surface.height", "", false},
      {Aov::kSurfaceNormal, "surface.normal", "XYZ", false},
      {Aov::kHitKind, "hit.kind", "", true},
      {Aov::kHitPosition, "hit.position", "XYZ", false},
      {Aov::kHitId, "hit.id", "", true},
      {Aov::kHitOutside, "hit.outside", "", true},
  };
  return infos;
}

void copy_aovs(const FrameData& f, const RenderScene& scene, Frame& out) {
  out.aovs.clear();
  const std::size_t pixels = static_cast<std::size_t>(f.grid.width_px) * static_cast<std::size_t>(f.grid.height_px);
  for (const AovInfo& info : aov_infos()) {
    if (((f.settings.aovs >> static_cast<int>(info.aov)) & 1u) == 0) continue;
    AovImage image{info.aov, 1, {}, {}};
    if (info.is_uint) {
      image.uints.reserve(pixels);
      for_each_pixel(f, [&](const Pixel& p) { image.uints.push_back(uint_at(f, scene, info.aov, p)); });
    } else if (std::string_view(info.channels) == "XYZ") {
      image.channels = 3;
      image.floats.reserve(pixels * 3);
      for_each_pixel(f, [&](const Pixel& p) {
        const Vec3f v = vector_at(f, info.aov, p);
        image.floats.insert(image.floats.end(), {v.x, v.y, v.z});
      });
    } else {
      image.floats.reserve(pixels);
      for_each_pixel(f, [&](const Pixel& p) {
        image.floats.push_back(info.aov == Aov::kDepth ? depth_m(f, p) : surface_height_m(f, p));
      });
    }
    out.aovs.push_back(std::move(image));
  }
}

void copy_linear(const FrameData& f, Frame& out) {
  out.linear.clear();
  out.linear.reserve(static_cast<std::size_t>(f.grid.width_px) * static_cast<std::size_t>(f.grid.height_px) * 4);
  for_each_pixel(f, [&](const Pixel& p) {
    out.linear.insert(out.linear.end(),
                      {f.lit.red[p.slot], f.lit.green[p.slot], f.lit.blue[p.slot], f.lit.alpha[p.slot]});
  });
}

}  // namespace shoal
