// Blended sheets above, in, under and through water, seen from above and from under it, against rays in double that
// follow Snell, Fresnel and Beer-Lambert.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "blend_scene.h"
#include "oracle_scene.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

constexpr int kWidth = 96, kHeight = 72;
constexpr double kDepth_m = 2, kIor = 1.333;
constexpr Vec3f kAbsorption{0.35f, 0.07f, 0.03f}, kSky{0.25f, 0.5f, 0.75f};

// A floor, and sheets round it; the water's plane is y = 0.
std::vector<Sheet> make_sheets() {
  const auto level = [](float x0, float x1, float z0, float z1, float y, Vec4f color, bool blended = true) {
    return quad({x0, y, z0}, {x0, y, z1}, {x1, y, z1}, {x1, y, z0}, color, blended);
  };
  const auto upright = [](float x0, float x1, float y0, float y1, float z, Vec4f color) {
    return quad({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}, color);
  };
  return {
      level(-3, 3, -3, 3, -1.75f, {0.75f, 0.625f, 0.5f, 1}, false),
      level(-1.5f, 0.5f, -1, 1, -0.75f, {0.125f, 0.875f, 0.25f, 0.5f}),          // in the water
      level(-0.75f, 1.25f, -1.5f, 0.25f, -1.25f, {0.875f, 0.125f, 0.5f, 0.4f}),  // under that
      level(-0.5f, 1.5f, -0.5f, 1.5f, 0.5f, {0.25f, 0.25f, 1, 0.3f}),            // above
      upright(-2, 2, -1, 0.75f, -1.25f, {1, 0.75f, 0.125f, 0.35f}),              // through the surface
      upright(-1, 1.75f, -1.5f, 1, 0.75f, {0.5f, 0.125f, 0.75f, 0.2f}),          // through it, nearer
      level(2.25f, 5, -4, 4, -1, {0.25f, 0.75f, 0.875f, 0.5f}),                  // in part beside the water
  };
}

RenderScene make_scene() {
  Scene scene = scene_of(make_sheets(), kSky);
  Node water;
  water.water = 0;
  WaterSpec spec;
  spec.has_size = true;
  spec.size_x = spec.size_z = 5;
  spec.has_depth = true;
  spec.depth = static_cast<float>(kDepth_m);
  spec.ior = static_cast<float>(kIor);
  spec.absorption = kAbsorption;
  scene.waters.push_back(spec);
  scene.nodes.push_back(water);
  return build_render_scene(scene);
}

// What a ray sees, and what it met on the way: another list there is another picture.
struct Seen {
  std::array<double, 3> rgb{};
  std::string met;
};

class Oracle {
 public:
  explicit Oracle(bool bend) : sheets_(make_sheets()), bend_(bend) {}

  Seen trace(const Camera& camera, double x, double y) const {
    const double per_px = 2.0 * static_cast<double>(camera.tan_half_yfov) / kHeight;
    const Vec3d o = as_double(camera.position_world);
    const Vec3d d = as_double(camera.forward_world) + as_double(camera.right_world) * ((x - 0.5 * kWidth) * per_px) +
                    as_double(camera.up_world) * ((0.5 * kHeight - y) * per_px);
    const bool in_water = o.y < 0 && o.y > -kDepth_m && std::fabs(o.x) < 2.5 && std::fabs(o.z) < 2.5;
    return trace(o, unit_of(d), in_water, true);
  }

 private:
  struct Meeting {
    double t;
    const Sheet* sheet;
  };

  // Sheets along a ray, nearest first.
  std::vector<Meeting> meetings(Vec3d o, Vec3d d, double end) const {
    std::vector<Meeting> out;
    for (const Sheet& s : sheets_) {
      const Vec3d a = as_double(s.corners[0]), u = as_double(s.corners[1]) - a, v = as_double(s.corners[5]) - a;
      const Vec3d n = cross(u, v);
      const double t = dot(a - o, n) / dot(d, n);
      if (!(t > 0) || t >= end) continue;
      const Vec3d r = o + d * t - a;
      const double i = dot(r, u) / dot(u, u), j = dot(r, v) / dot(v, v);
      if (i < 0 || i > 1 || j < 0 || j > 1) continue;
      out.push_back({t, &s});
    }
    std::sort(out.begin(), out.end(), [](const Meeting& p, const Meeting& q) { return p.t < q.t; });
    return out;
  }

  static std::array<double, 3> kept(double path_m) {
    return {std::exp(-static_cast<double>(kAbsorption.x) * path_m),
            std::exp(-static_cast<double>(kAbsorption.y) * path_m),
            std::exp(-static_cast<double>(kAbsorption.z) * path_m)};
  }

  Seen trace(Vec3d o, Vec3d d, bool in_water, bool meets_surface) const {
    double surface = -o.y / d.y;
    const Vec3d p = o + d * surface;
    if (!meets_surface || !(surface > 0) || std::fabs(p.x) > 2.5 || std::fabs(p.z) > 2.5) surface = 1e30;
    const std::vector<Meeting> met = meetings(o, d, surface);
    Seen seen;
    std::size_t end = 0;
    while (end < met.size() && met[end].sheet->blended) ++end;
    double behind_m;
    if (end < met.size()) {
      const Vec4f c = met[end].sheet->color;
      seen.rgb = {static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z)};
      seen.met = name(met[end].sheet);
      behind_m = met[end].t;
    } else if (surface < 1e30) {
      seen = at_surface(p, d, in_water);
      behind_m = surface;
    } else {
      seen.rgb = {static_cast<double>(kSky.x), static_cast<double>(kSky.y), static_cast<double>(kSky.z)};
      seen.met = "sky";
      // Out through the bottom; what the eye itself sees of the sky is behind all the water there is.
      behind_m = meets_surface ? 1e6 : kDepth_m / std::max(std::fabs(d.y), 1e-3);
    }
    if (in_water) absorb(seen.rgb, behind_m);
    for (std::size_t i = end; i-- > 0;) {
      const Vec4f c = met[i].sheet->color;
      std::array<double, 3> own = {static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z)};
      if (in_water) absorb(own, met[i].t);
      const double a = static_cast<double>(c.w);
      for (std::size_t k = 0; k < 3; ++k) seen.rgb[k] = seen.rgb[k] * (1 - a) + own[k] * a;
      seen.met = name(met[i].sheet) + seen.met;
    }
    return seen;
  }

  Seen at_surface(Vec3d p, Vec3d d, bool from_water) const {
    const Vec3d n{0, from_water ? -1.0 : 1.0, 0};
    const double eta = from_water ? kIor : 1 / kIor, cos_i = -dot(d, n), sin2 = eta * eta * (1 - cos_i * cos_i);
    const bool total = sin2 >= 1;
    const double cos_t = total ? 0 : std::sqrt(1 - sin2);
    const double rs = (eta * cos_i - cos_t) / (eta * cos_i + cos_t), rp = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const double reflectance = total ? 1 : 0.5 * (rs * rs + rp * rp);
    Seen through, back;
    if (!total) through = trace(p, bend_ ? d * eta + n * (eta * cos_i - cos_t) : d, !from_water, false);
    if (from_water) {
      back = trace(p, d + n * (2 * cos_i), true, false);
    } else {
      back.rgb = {static_cast<double>(kSky.x), static_cast<double>(kSky.y), static_cast<double>(kSky.z)};
    }
    Seen seen;
    seen.met = "(" + through.met + "|" + back.met + ")" + (total ? "total" : "");
    for (std::size_t k = 0; k < 3; ++k) seen.rgb[k] = through.rgb[k] * (1 - reflectance) + back.rgb[k] * reflectance;
    return seen;
  }

  static void absorb(std::array<double, 3>& rgb, double path_m) {
    const std::array<double, 3> k = kept(path_m);
    for (std::size_t i = 0; i < 3; ++i) rgb[i] *= k[i];
  }
  std::string name(const Sheet* s) const { return std::string(1, static_cast<char>('a' + (s - sheets_.data()))); }

  std::vector<Sheet> sheets_;
  bool bend_;
};

struct Place {
  const char* name;
  Vec3f eye, target;
  int least_checked;  // percent of the pixels
};

void check_view(const RenderScene& scene, const Place& place, const char* method) {
  CAPTURE(place.name, method);
  const Camera camera = shoal_test::camera_at(place.eye, place.target, 1.1);
  FrameSettings settings;
  settings.width_px = kWidth, settings.height_px = kHeight;
  settings.isa = supported_isas().front();
  settings.threads = 2;
  settings.method = method;
  settings.reflections = Reflections::kEnvironment;  // what the oracle does
  settings.keep_linear = true;
  const Frame frame = render_scene(scene, camera, settings);
  CHECK(frame.water_pixels > 0);
  const Oracle oracle(std::string(method) != "none");
  int checked = 0, wrong = 0;
  double worst = 0;
  std::string first;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Seen e = oracle.trace(camera, x + 0.5, y + 0.5);
      bool edge = false;  // the broad phase is straight to a quarter of a pixel
      for (int i = 0; i < 9 && !edge; ++i)
        edge = oracle.trace(camera, x + 0.5 + 0.4 * (i % 3 - 1), y + 0.5 + 0.4 * (i / 3 - 1)).met != e.met;
      if (edge) continue;
      ++checked;
      const float* got = frame.linear.data() + 4 * static_cast<std::size_t>(y * kWidth + x);
      for (std::size_t k = 0; k < 3; ++k) {
        const double off = std::fabs(static_cast<double>(got[k]) - e.rgb[k]);
        worst = std::max(worst, off);
        if (off > 3e-5 && wrong++ == 0)
          first = std::to_string(x) + ", " + std::to_string(y) + " channel " + std::to_string(k) + ": " +
                  std::to_string(got[k]) + ", expected " + std::to_string(e.rgb[k]) + " past " + e.met;
      }
    }
  INFO(wrong << " values are off by up to " << worst << "; the first at " << first);
  CHECK(wrong == 0);
  CHECK(checked * 100 > kWidth * kHeight * place.least_checked);
}

}  // namespace

TEST_CASE("blend: above, in and through the water, seen from above and from under it", "[blend]") {
  const RenderScene scene = make_scene();
  const Place places[] = {
      {"high", {1.5f, 4, 5}, {0, -0.5f, 0}, 75},
      {"low", {-3.5f, 0.9f, 3.5f}, {0.25f, -0.25f, 0}, 75},
      {"under, up", {0.5f, -1.5f, 2.25f}, {0, 0, 0}, 75},
      {"under, level", {-2.2f, -0.5f, 2.2f}, {0.5f, -0.5f, -1}, 75},
  };
  for (const Place& place : places)
    for (const char* method : {"hybrid", "none", "ray-traced"}) check_view(scene, place, method);
}

TEST_CASE("blend: every stage is the same for any threads, tiles and instruction set", "[blend]") {
  const RenderScene scene = make_scene();
  for (const Vec3f eye : {Vec3f{1.5f, 4, 5}, Vec3f{0.5f, -1.5f, 2.25f}}) {
    const Camera camera = shoal_test::camera_at(eye, {0, 0, 0}, 1.1);
    FrameSettings settings;
    settings.width_px = 131, settings.height_px = 77;
    settings.digests = true;
    settings.threads = 1;
    settings.shadow_map_px = 512;
    settings.isa = supported_isas().back();
    for (const int spp : {1, 2}) {
      settings.spp = spp, settings.tile_px = 64;
      const Frame expected = render_scene(scene, camera, settings);
      for (const Isa isa : supported_isas())
        for (const int tile : {16, 64, 256})
          for (const int threads : {1, 2, 7}) {
            FrameSettings other = settings;
            other.isa = isa, other.tile_px = tile, other.threads = threads;
            const Frame got = render_scene(scene, camera, other);
            CAPTURE(isa_name(isa), tile, threads, spp);
            CHECK(got.digests == expected.digests);
            CHECK(got.srgb8 == expected.srgb8);
          }
    }
  }
}
