#include "refraction/aov.h"

#include <limits>

#include "raster/geometry_lookup.h"

namespace shoal {

namespace {

constexpr std::uint32_t kNoneOut = 0xFFFFFFFFu;

// One pixel's place in the blocked buffers, and what it shows.
struct Pixel {
  std::size_t slot;
  std::int32_t id;
  bool water() const { return id < 0; }
  bool triangle() const { return id >= 0 && id != kNoId; }
  std::size_t body() const { return static_cast<std::size_t>(id - kFirstWaterId); }
};

std::uint32_t id_out(std::int32_t id) { return id >= 0 && id != kNoId ? static_cast<std::uint32_t>(id) : kNoneOut; }
Vec3f at(const PlaneXyz& planes, std::size_t slot) { return {planes.x[slot], planes.y[slot], planes.z[slot]}; }

// Metres along the view axis; infinity where nothing is.
float depth_m(const AovIn& in, const Pixel& p) {
  if (p.id == kNoId) return std::numeric_limits<float>::infinity();
  return view_depth_m(in.view, in.targets.direct.depth[p.slot]);
}

// The surface of a body over a point of it.
struct Waves {
  float height_m = 0;
  Vec3f normal{0, 0, 0};  // on the plane normal's side
};
Waves waves_of(const AovIn& in, const Pixel& p) {
  if (!p.water()) return {};
  const WaterOptics& optics = in.water[p.body()];
  const WaterBody& body = optics.body();
  if (optics.surface() == nullptr) return {0.0f, body.normal};
  const Vec3f position = at(in.targets.gbuffer.position_world, p.slot);
  const Vec3f on_plane = on_body<float>(body, position);
  return {surface_at<float>(*optics.surface(), on_plane.x, on_plane.z).height_m,
          displaced_normal<float>(body, *optics.surface(), position)};
}

// The AOVs: name and channels, and the value of a pixel, of one of three kinds.
struct Row {
  AovInfo info;
  float (*number)(const AovIn&, const Pixel&);
  Vec3f (*vector)(const AovIn&, const Pixel&);
  std::uint32_t (*count)(const AovIn&, const Pixel&);
};

Row number(Aov aov, const char* name, const char* channels, float (*value)(const AovIn&, const Pixel&)) {
  return {{aov, name, channels, false}, value, nullptr, nullptr};
}
Row vector(Aov aov, const char* name, Vec3f (*value)(const AovIn&, const Pixel&)) {
  return {{aov, name, "XYZ", false}, nullptr, value, nullptr};
}
Row count(Aov aov, const char* name, std::uint32_t (*value)(const AovIn&, const Pixel&)) {
  return {{aov, name, "", true}, nullptr, nullptr, value};
}

const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      number(Aov::kDepth, "depth", "Z", &depth_m),
      vector(Aov::kNormal, "normal",
             [](const AovIn& in, const Pixel& p) { return at(in.targets.gbuffer.normal_world, p.slot); }),
      vector(Aov::kPosition, "position",
             [](const AovIn& in, const Pixel& p) { return at(in.targets.gbuffer.position_world, p.slot); }),
      count(Aov::kIdTriangle, "id.triangle", [](const AovIn&, const Pixel& p) { return id_out(p.id); }),
      count(Aov::kIdNode, "id.node",
            [](const AovIn& in, const Pixel& p) {
              if (p.triangle()) return in.scene.geometry.drawables[drawable_of(in.scene.geometry, p.id)].node;
              return p.water() ? in.scene.waters[p.body()].node : kNoneOut;
            }),
      vector(Aov::kVirtual, "virtual",
             [](const AovIn& in, const Pixel& p) {
               return at(p.water() ? in.targets.hits.virtual_world : in.targets.gbuffer.position_world, p.slot);
             }),
      count(Aov::kWaterMask, "water.mask",
            [](const AovIn&, const Pixel& p) { return p.water() ? static_cast<std::uint32_t>(p.body()) + 1u : 0u; }),
      number(Aov::kSurfaceHeight, "surface.height", "",
             [](const AovIn& in, const Pixel& p) { return waves_of(in, p).height_m; }),
      vector(Aov::kSurfaceNormal, "surface.normal",
             [](const AovIn& in, const Pixel& p) { return waves_of(in, p).normal; }),
      count(Aov::kHitKind, "hit.kind",
            [](const AovIn& in, const Pixel& p) { return static_cast<std::uint32_t>(in.targets.hits.kind[p.slot]); }),
      vector(Aov::kHitPosition, "hit.position",
             [](const AovIn& in, const Pixel& p) { return at(in.targets.hits.position_world, p.slot); }),
      count(Aov::kHitId, "hit.id", [](const AovIn& in, const Pixel& p) { return id_out(in.targets.hits.id[p.slot]); }),
      count(
          Aov::kHitOutside, "hit.outside",
          [](const AovIn& in, const Pixel& p) { return static_cast<std::uint32_t>(in.targets.hits.outside[p.slot]); }),
  };
  return all;
}

template <class Body>
void for_each_pixel(const FrameGrid& frame, const VisibilityBuffer& direct, Body body) {
  for (int y = 0; y < frame.height_px; ++y)
    for (int x = 0; x < frame.width_px; ++x) {
      const std::size_t slot = frame.slot(x, y);
      body(Pixel{slot, direct.id[slot]});
    }
}

}  // namespace

const std::vector<AovInfo>& aov_infos() {
  static const std::vector<AovInfo> infos = [] {
    std::vector<AovInfo> list;
    for (const Row& row : rows()) list.push_back(row.info);
    return list;
  }();
  return infos;
}

void copy_aovs(const AovIn& in, std::uint32_t aovs, Frame& out) {
  out.aovs.clear();
  const std::size_t pixels = static_cast<std::size_t>(in.frame.width_px) * static_cast<std::size_t>(in.frame.height_px);
  for (const Row& row : rows()) {
    if (((aovs >> static_cast<int>(row.info.aov)) & 1u) == 0) continue;
    AovImage image{row.info.aov, 1, {}, {}};
    if (row.count != nullptr) {
      image.uints.reserve(pixels);
      for_each_pixel(in.frame, in.targets.direct, [&](const Pixel& p) { image.uints.push_back(row.count(in, p)); });
    } else if (row.vector != nullptr) {
      image.channels = 3;
      image.floats.reserve(pixels * 3);
      for_each_pixel(in.frame, in.targets.direct, [&](const Pixel& p) {
        const Vec3f v = row.vector(in, p);
        image.floats.insert(image.floats.end(), {v.x, v.y, v.z});
      });
    } else {
      image.floats.reserve(pixels);
      for_each_pixel(in.frame, in.targets.direct, [&](const Pixel& p) { image.floats.push_back(row.number(in, p)); });
    }
    out.aovs.push_back(std::move(image));
  }
}

void copy_linear(const Targets& targets, const FrameGrid& frame, Frame& out) {
  out.linear.clear();
  out.linear.reserve(static_cast<std::size_t>(frame.width_px) * static_cast<std::size_t>(frame.height_px) * 4);
  const LitBuffer& lit = targets.lit;
  for_each_pixel(frame, targets.direct, [&](const Pixel& p) {
    out.linear.insert(out.linear.end(), {lit.red[p.slot], lit.green[p.slot], lit.blue[p.slot], lit.alpha[p.slot]});
  });
}

}  // namespace shoal
