#include "refraction/aov.h"

#include <limits>
#include <string_view>
#include <type_traits>

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

// An AOV: its name and channels, and how a pixel's value is found. One of the three functions converts what targets
// hold; where all are null the AOV is a target as it is, by the table of targets (refraction/data/targets.h).
struct Row {
  AovInfo info;
  float (*number)(const AovIn&, const Pixel&) = nullptr;
  Vec3f (*vector)(const AovIn&, const Pixel&) = nullptr;
  std::uint32_t (*count)(const AovIn&, const Pixel&) = nullptr;
};

std::uint32_t node_of(const AovIn& in, const Pixel& p) {
  if (p.triangle()) return in.scene.geometry.drawables[drawable_of(in.scene.geometry, p.id)].node;
  return p.water() ? in.scene.waters[p.body()].node : kNoneOut;
}
std::uint32_t mask_of(const AovIn&, const Pixel& p) {
  return p.water() ? static_cast<std::uint32_t>(p.body()) + 1u : 0u;
}
std::uint32_t triangle_of(const AovIn&, const Pixel& p) { return id_out(p.id); }
std::uint32_t hit_of(const AovIn& in, const Pixel& p) { return id_out(in.targets.hits.id[p.slot]); }
Vec3f image_of(const AovIn& in, const Pixel& p) {
  return at(p.water() ? in.targets.hits.virtual_world : in.targets.gbuffer.position_world, p.slot);
}
float height_of(const AovIn& in, const Pixel& p) { return waves_of(in, p).height_m; }
Vec3f normal_of(const AovIn& in, const Pixel& p) { return waves_of(in, p).normal; }

const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      {.info = {Aov::kDepth, "depth", "Z", false}, .number = &depth_m},
      {.info = {Aov::kNormal, "normal", "XYZ", false}},
      {.info = {Aov::kPosition, "position", "XYZ", false}},
      {.info = {Aov::kIdTriangle, "id.triangle", "", true}, .count = &triangle_of},
      {.info = {Aov::kIdNode, "id.node", "", true}, .count = &node_of},
      {.info = {Aov::kVirtual, "virtual", "XYZ", false}, .vector = &image_of},
      {.info = {Aov::kWaterMask, "water.mask", "", true}, .count = &mask_of},
      {.info = {Aov::kSurfaceHeight, "surface.height", "", false}, .number = &height_of},
      {.info = {Aov::kSurfaceNormal, "surface.normal", "XYZ", false}, .vector = &normal_of},
      {.info = {Aov::kHitKind, "hit.kind", "", true}},
      {.info = {Aov::kHitPosition, "hit.position", "XYZ", false}},
      {.info = {Aov::kHitId, "hit.id", "", true}, .count = &hit_of},
      {.info = {Aov::kHitApproximate, "hit.approximate", "", true}},
      {.info = {Aov::kHitSecondary, "hit.secondary", "", true}},
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

namespace {

// The planes of the target that an AOV shows as it is, interleaved.
void copy_target(const AovIn& in, const Row& row, AovImage& image) {
  std::vector<const FloatPlane*> floats;
  visit_planes(in.targets, TargetNeeds{}, [&](const TargetInfo& info, const auto& plane) {
    if (info.aov == nullptr || std::string_view(info.aov) != row.info.name) return;
    if constexpr (std::is_same_v<decltype(plane), const FloatPlane&>)
      floats.push_back(&plane);
    else
      for_each_pixel(in.frame, in.targets.direct,
                     [&](const Pixel& p) { image.uints.push_back(static_cast<std::uint32_t>(plane[p.slot])); });
  });
  if (floats.empty()) return;
  image.channels = static_cast<int>(floats.size());
  for_each_pixel(in.frame, in.targets.direct, [&](const Pixel& p) {
    for (const FloatPlane* plane : floats) image.floats.push_back((*plane)[p.slot]);
  });
}

void copy_converted(const AovIn& in, const Row& row, AovImage& image) {
  const auto each = [&](auto body) { for_each_pixel(in.frame, in.targets.direct, body); };
  if (row.count != nullptr) each([&](const Pixel& p) { image.uints.push_back(row.count(in, p)); });
  if (row.number != nullptr) each([&](const Pixel& p) { image.floats.push_back(row.number(in, p)); });
  if (row.vector == nullptr) return;
  image.channels = 3;
  each([&](const Pixel& p) {
    const Vec3f v = row.vector(in, p);
    image.floats.insert(image.floats.end(), {v.x, v.y, v.z});
  });
}

}  // namespace

void copy_aovs(const AovIn& in, std::uint32_t aovs, Frame& out) {
  out.aovs.clear();
  for (const Row& row : rows()) {
    if (((aovs >> static_cast<int>(row.info.aov)) & 1u) == 0) continue;
    AovImage image{row.info.aov, 1, {}, {}};
    const bool converts = row.number != nullptr || row.vector != nullptr || row.count != nullptr;
    converts ? copy_converted(in, row, image) : copy_target(in, row, image);
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
