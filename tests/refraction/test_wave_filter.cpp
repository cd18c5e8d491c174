// Waves that are smaller than pixels: what a frame shows of them is what many samples of the waves themselves show.
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

#include "core/isa.h"
#include "core/thread_pool.h"
#include "shading/environment/build.h"
#include "shading/sky.h"
#include "water/rough_mirror.h"
#include "refraction/renderer.h"
#include "scene/scene.h"

namespace {

using namespace shoal;

constexpr double kTurn = 6.283185307179586;

Background clear_day(Vec3f to_sun) {
  Background b;
  b.kind = Background::Kind::kSky;
  b.zenith = {0.18f, 0.38f, 0.78f};
  b.horizon = {0.72f, 0.83f, 0.94f};
  b.ground = {0.35f, 0.33f, 0.30f};
  b.to_sun_world = normalize(to_sun);
  b.sun = {2.6f, 2.45f, 2.2f};
  return b;
}

Vec3f normal_of(double slope_x, double slope_z) {
  return surface_normal<float>({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, static_cast<float>(slope_x),
                               static_cast<float>(slope_z));
}

// A ray that comes down at an angle onto waves of which a mean slope is left.
ExactRay<float> ray_at_water(double elevation, double slope_x, double slope_z, double hidden, bool displaced) {
  ExactRay<float> at;
  at.incident =
      normalize(Vec3f{static_cast<float>(std::cos(elevation)), static_cast<float>(-std::sin(elevation)), 0.0f});
  at.eta = 1.0f / 1.333f;
  at.plane_normal = {0, 1, 0};
  at.wave_normal = normal_of(slope_x, slope_z);
  at.normal = displaced ? at.wave_normal : valid_normal<float>(at.incident, at.plane_normal, at.wave_normal, at.eta);
  at.slope_variance = static_cast<float>(hidden);
  at.crosses = true;
  go_on_from(at);
  return at;
}

struct Mirrored {
  double reflectance = 0;
  double light[3] = {};  // reflectance times what is seen
};

// The mean over so many slopes of a normal distribution.
Mirrored mean_over_slopes(const Background& background, const ExactRay<float>& at, bool displaced, double slope_x,
                          double slope_z, double hidden) {
  std::mt19937 random(77);
  std::normal_distribution<double> normal(0, std::sqrt(0.5 * hidden));
  Mirrored mean;
  double shares = 0;
  for (int i = 0; i < 60000; ++i) {
    const double sx = slope_x + normal(random), sz = slope_z + normal(random);
    Vec3f n = normal_of(sx, sz);
    double share = 1;
    if (displaced)
      share = std::max(0.0, static_cast<double>(-dot(at.incident, n)) / static_cast<double>(n.y));
    else
      n = valid_normal<float>(at.incident, {0, 1, 0}, n, at.eta);
    if (share == 0) continue;
    const double reflects =
        share * static_cast<double>(fresnel_dielectric(std::min(-dot(at.incident, n), 1.0f), at.eta));
    const Vec3f seen = background_radiance<float>(background, reflect(at.incident, n));
    shares += share;
    mean.reflectance += reflects;
    mean.light[0] += reflects * static_cast<double>(seen.x);
    mean.light[1] += reflects * static_cast<double>(seen.y);
    mean.light[2] += reflects * static_cast<double>(seen.z);
  }
  mean.reflectance /= shares;
  for (double& l : mean.light) l /= shares;
  return mean;
}

// A sheet of water far wider than one sees, over the basin of `box`.
RenderScene wide_water(WaveFilter filter) {
  for (const ProceduralScene& p : procedural_scenes()) {
    if (std::string(p.name) != "box") continue;
    Scene scene = p.make(1000);
    WaterSpec& water = scene.waters.at(0);
    water.has_size = true;
    water.size_x = water.size_z = 2000;
    water.surface.kind = SurfaceKind::kGradientWaves;
    water.surface.slope = 0.08f;
    water.surface.filter = filter;
    return build_render_scene(scene);
  }
  throw std::runtime_error("no box");
}

Camera over_the_water() {
  Camera camera;
  camera.position_world = {60, 3, 60};
  camera.right_world = {0.70710678f, 0, -0.70710678f};
  camera.up_world = {0, 1, 0};
  camera.forward_world = {0.70710678f, 0, 0.70710678f};
  camera.tan_half_yfov = 0.3f;
  return camera;
}

constexpr int kWidth = 160, kHeight = 90;

std::vector<float> rendered(const RenderScene& scene, const char* method, int spp) {
  FrameSettings settings;
  settings.method = method;
  settings.width_px = kWidth, settings.height_px = kHeight;
  settings.threads = 2;
  settings.isa = supported_isas().front();
  settings.shadows = Shadows::kOff;
  settings.spp = spp;
  settings.keep_linear = true;
  Renderer renderer(scene, settings);
  Frame frame;
  renderer.render(over_the_water(), 1.5, frame);
  return frame.linear;
}

// Of rows of the frame, one channel.
struct Moments {
  double mean = 0, deviation = 0;
};
Moments of_rows(const std::vector<float>& rgba, int first, int last, int channel) {
  double sum = 0, square = 0;
  const double count = static_cast<double>(last - first) * kWidth;
  for (int y = first; y < last; ++y) {
    double row = 0;
    for (int x = 0; x < kWidth; ++x)
      row += static_cast<double>(rgba[static_cast<std::size_t>(4 * (y * kWidth + x) + channel)]);
    sum += row;
    // About the row's own mean: the gradient from row to row is no noise.
    for (int x = 0; x < kWidth; ++x)
      square += std::pow(
          static_cast<double>(rgba[static_cast<std::size_t>(4 * (y * kWidth + x) + channel)]) - row / kWidth, 2);
  }
  return {sum / count, std::sqrt(square / count)};
}

}  // namespace

TEST_CASE("waves: what rough water mirrors is the mean over its slopes", "[waves]") {
  WaterBody body;
  for (const bool displaced : {false, true}) {
    for (const Vec3f to_sun : {Vec3f{0.41f, 0.82f, 0.41f}, Vec3f{1.0f, 0.25f, 0.0f}}) {
      const Background sky = clear_day(to_sun);
      for (const double elevation : {0.03, 0.08, 0.2, 0.5, 1.0, 1.5}) {
        for (const double sigma : {0.01, 0.03, 0.1}) {
          const double hidden = 2 * sigma * sigma;
          const ExactRay<float> at = ray_at_water(elevation, 0.01, -0.02, hidden, displaced);
          const Mirrored want = mean_over_slopes(sky, at, displaced, 0.01, -0.02, hidden);
          const RoughMirror<float> mirror = mirror_roughly<float>(SkyView{sky}, body, displaced, at.reflected, at);
          const double r = static_cast<double>(mirror.reflectance);
          const double got[3] = {r * static_cast<double>(mirror.radiance.x), r * static_cast<double>(mirror.radiance.y),
                                 r * static_cast<double>(mirror.radiance.z)};
          CAPTURE(displaced, to_sun.y, elevation, sigma, r, want.reflectance, got[0], want.light[0], got[2],
                  want.light[2]);
          const double bound = sigma < 0.05 ? 0.05 : displaced ? 0.15 : 0.08;
          CHECK(r == Approx(want.reflectance).epsilon(sigma < 0.05 ? 0.01 : 0.06));
          CHECK(got[0] == Approx(want.light[0]).epsilon(bound));
          CHECK(got[2] == Approx(want.light[2]).epsilon(bound));
        }
      }
    }
  }
}

TEST_CASE("waves: rough water mirrors an environment by its lobes", "[waves]") {
  // A sky that brightens towards a wide glow, 0.25 rad, low in front.
  const Vec3f glow = normalize(Vec3f{1.0f, 0.3f, 0.2f});
  EquirectImage image{512, 256, {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double phi = (x + 0.5 - 256) * kTurn / 512, theta = (y + 0.5) * kTurn / 512;
      const double dx = std::sin(theta) * std::cos(phi), dy = std::cos(theta), dz = std::sin(theta) * std::sin(phi);
      const double cosine =
          dx * static_cast<double>(glow.x) + dy * static_cast<double>(glow.y) + dz * static_cast<double>(glow.z);
      const double light = 4 * std::exp((cosine - 1) * 16);
      for (const double base : {0.3, 0.5, 0.9}) image.rgb.push_back(static_cast<float>(base * (1 - 0.5 * dy) + light));
    }
  }
  ThreadPool pool(2);
  const auto environment = std::make_shared<const Environment>(make_environment(image, pool));
  Background sky;
  sky.kind = Background::Kind::kEnvironment;
  sky.environment = environment;
  WaterBody body;
  for (const double elevation : {0.03, 0.1, 0.3, 0.6, 1.0, 1.5}) {
    for (const double sigma : {0.01, 0.03, 0.1}) {
      const double hidden = 2 * sigma * sigma;
      const ExactRay<float> at = ray_at_water(elevation, 0.01, -0.02, hidden, false);
      const Mirrored want = mean_over_slopes(sky, at, false, 0.01, -0.02, hidden);
      const RoughMirror<float> mirror = mirror_roughly<float>(SkyView{sky}, body, false, at.reflected, at);
      const double got = static_cast<double>(mirror.reflectance) * static_cast<double>(mirror.radiance.z);
      CAPTURE(elevation, sigma, mirror.reflectance, want.reflectance, got, want.light[2]);
      CHECK(static_cast<double>(mirror.reflectance) == Approx(want.reflectance).epsilon(0.08));
      CHECK(got == Approx(want.light[2]).epsilon(sigma < 0.05 ? 0.07 : 0.17));
    }
  }
}

TEST_CASE("waves: without hidden slopes nothing changes", "[waves]") {
  WaterBody body;
  const Background sky = clear_day({0.41f, 0.82f, 0.41f});
  const ExactRay<float> at = ray_at_water(0.3, 0.05, 0.02, 0.0, false);
  const RoughMirror<float> mirror = mirror_roughly<float>(SkyView{sky}, body, false, at.reflected, at);
  const Vec3f sharp = background_radiance<float>(sky, at.reflected);
  CHECK(mirror.reflectance == at.reflectance);
  CHECK((mirror.radiance.x == sharp.x && mirror.radiance.y == sharp.y && mirror.radiance.z == sharp.z));
}

TEST_CASE("waves: far water is the mean of its waves, without their noise", "[waves]") {
  const RenderScene filtered = wide_water(WaveFilter::kFootprint), plain = wide_water(WaveFilter::kNone);
  for (const char* method : {"hybrid", "ray-traced"}) {
    const std::vector<float> got = rendered(filtered, method, 1), noisy = rendered(plain, method, 1),
                             want = rendered(plain, method, 64);
    // From below the horizon (row 45) down: some thousand to a dozen metres away.
    for (const auto& [first, last] : {std::pair{47, 50}, std::pair{50, 56}, std::pair{56, 66}, std::pair{66, 80}}) {
      for (const int channel : {0, 2}) {
        const Moments g = of_rows(got, first, last, channel), n = of_rows(noisy, first, last, channel),
                      w = of_rows(want, first, last, channel);
        CAPTURE(method, first, channel, g.mean, w.mean, g.deviation, n.deviation, w.deviation);
        CHECK(g.mean == Approx(w.mean).epsilon(0.05));
        CHECK(g.deviation < 0.15 * n.deviation);
      }
    }
  }
}
