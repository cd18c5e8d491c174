#include "compare/hits.h"

#include <cmath>

#include "core/error.h"
#include "core/float_mode.h"
#include "raster/geometry_lookup.h"
#include "refraction/broad/broad_phase.h"

namespace shoal {

namespace {

// The buffers of one frame.
struct Hits {
  const std::vector<std::uint32_t>& mask;
  const std::vector<std::uint32_t>& kind;
  const std::vector<float>& position;
  const std::vector<std::uint32_t>& id;
  const std::vector<std::uint32_t>& secondary;

  HitKind kind_at(std::size_t i) const { return static_cast<HitKind>(kind[i]); }
  Vec3f at(std::size_t i) const { return {position[3 * i], position[3 * i + 1], position[3 * i + 2]}; }
};

const AovImage& require_aov(const Frame& frame, Aov aov) {
  const AovImage* image = find_aov(frame, aov);
  if (!image) throw UsageError("compare_hits: a frame without hit buffers; expected one drawn with kHitAovs");
  return *image;
}

Hits hits_of(const Frame& frame) {
  return {require_aov(frame, Aov::kWaterMask).uints, require_aov(frame, Aov::kHitKind).uints,
          require_aov(frame, Aov::kHitPosition).floats, require_aov(frame, Aov::kHitId).uints,
          require_aov(frame, Aov::kHitSecondary).uints};
}

// The drawable of a triangle; the number of drawables for none.
std::size_t object_of(const Geometry& geometry, std::uint32_t triangle) {
  if (triangle == kNoTriangle || geometry.drawables.empty()) return geometry.drawables.size();
  return drawable_of(geometry, static_cast<std::int32_t>(triangle));
}

// Where the broad phase puts a point on the screen.
class Screen {
 public:
  Screen(const RenderScene& scene, const Camera& camera, int width_px, int height_px)
      : view_(make_view(camera, width_px, height_px, {0, 0})), diagonal_px_(std::hypot(width_px, height_px)) {
    for (const WaterBody& body : scene.waters) bodies_.push_back(make_broad_phase(body, view_));
  }

  double distance_px(std::uint32_t mask, Vec3f a, Vec3f b) const {
    const BroadPhase& body = bodies_.at(mask - 1);
    const ClipVertex<float> p = project(view_, virtual_position(body, a));
    const ClipVertex<float> q = project(view_, virtual_position(body, b));
    if (!(p.w > 0.0f && q.w > 0.0f)) return diagonal_px_;
    const auto off = [&](float pa, float qa) {
      return static_cast<double>(pa) / static_cast<double>(p.w) - static_cast<double>(qa) / static_cast<double>(q.w);
    };
    return std::hypot(off(p.x, q.x), off(p.y, q.y));
  }

 private:
  View view_;
  double diagonal_px_;
  std::vector<BroadPhase> bodies_;
};

double distance_m(Vec3f a, Vec3f b) {
  const double x = static_cast<double>(a.x) - static_cast<double>(b.x);
  const double y = static_cast<double>(a.y) - static_cast<double>(b.y);
  const double z = static_cast<double>(a.z) - static_cast<double>(b.z);
  return std::sqrt(x * x + y * y + z * z);
}

Percentiles percentiles(const std::vector<float>& errors) {
  return {percentile_of(errors, 0.5), percentile_of(errors, 0.95), percentile_of(errors, 0.99)};
}

std::uint8_t verdict(const Geometry& geometry, const Hits& reference, const Hits& method, std::size_t i) {
  const HitKind kind = reference.kind_at(i);
  if (method.kind_at(i) != kind) {
    return HitComparison::kWrongKind | HitComparison::kWrongObject | HitComparison::kWrongSurface;
  }
  std::uint8_t wrong = 0;
  if (object_of(geometry, reference.id[i]) != object_of(geometry, method.id[i])) wrong |= HitComparison::kWrongObject;
  const bool has_point = kind == HitKind::kSurface || kind == HitKind::kMirror;
  if (has_point && distance_m(reference.at(i), method.at(i)) > kWrongSurface_m) wrong |= HitComparison::kWrongSurface;
  return wrong;
}

}  // namespace

const AovImage* find_aov(const Frame& frame, Aov aov) {
  for (const AovImage& image : frame.aovs) {
    if (image.aov == aov) return &image;
  }
  return nullptr;
}

HitComparison compare_hits(const RenderScene& scene, const Camera& camera, const Frame& reference,
                           const Frame& method) {
  if (reference.width_px != method.width_px || reference.height_px != method.height_px) {
    throw UsageError("compare_hits: frames of different sizes; expected two of the same");
  }
  const FloatModeGuard mode;
  const Hits t = hits_of(reference), m = hits_of(method);
  const Screen screen(scene, camera, reference.width_px, reference.height_px);
  const std::size_t pixels = t.mask.size();
  HitComparison out;
  out.water.assign(pixels, false);
  out.error_map_px.assign(pixels, -1.0f);
  out.wrong.assign(pixels, 0);
  std::vector<float> errors_px, errors_m;
  std::uint64_t wrong_objects = 0, wrong_surfaces = 0, secondary = 0, primary_objects = 0, primary_surfaces = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (t.mask[i] == 0) continue;
    out.water[i] = true;
    ++out.water_pixels;
    out.wrong[i] = verdict(scene.geometry, t, m, i);
    const bool other_object = (out.wrong[i] & HitComparison::kWrongObject) != 0;
    const bool other_surface = (out.wrong[i] & HitComparison::kWrongSurface) != 0;
    wrong_objects += other_object, wrong_surfaces += other_surface;
    if (t.secondary[i] != 0)
      ++secondary;
    else
      primary_objects += other_object, primary_surfaces += other_surface;
    if (t.kind_at(i) != HitKind::kSurface || m.kind_at(i) != HitKind::kSurface) continue;
    errors_m.push_back(static_cast<float>(distance_m(t.at(i), m.at(i))));
    errors_px.push_back(static_cast<float>(screen.distance_px(t.mask[i], t.at(i), m.at(i))));
    out.error_map_px[i] = errors_px.back();
  }
  out.compared_pixels = errors_px.size();
  out.error_px = percentiles(errors_px);
  out.error_m = percentiles(errors_m);
  const auto water_pixels = static_cast<double>(out.water_pixels);
  out.wrong_object = static_cast<double>(wrong_objects) / water_pixels;
  out.wrong_surface = static_cast<double>(wrong_surfaces) / water_pixels;
  out.secondary_share = static_cast<double>(secondary) / water_pixels;
  const double primary_pixels = water_pixels - static_cast<double>(secondary);
  out.wrong_object_primary = static_cast<double>(primary_objects) / primary_pixels;
  out.wrong_surface_primary = static_cast<double>(primary_surfaces) / primary_pixels;
  return out;
}

}  // namespace shoal
