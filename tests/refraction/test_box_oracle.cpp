// Frames of the built-in scenes against the brute-force oracle, every pixel: where the primitive is the same, the point
// is the same up to rounding; where it is not, the pixel is at a silhouette, and counted.
#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "oracle_scene.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

constexpr int kWidth = 96, kHeight = 64;

// What a pixel of a frame shows, in the oracle's terms.
class FramePixels {
 public:
  explicit FramePixels(const Frame& frame) : frame_(frame) {}
  OraclePixel at(int x, int y) const {
    const std::size_t i = static_cast<std::size_t>(y * frame_.width_px + x);
    OraclePixel p;
    p.water = image_of(frame_, Aov::kWaterMask).uints[i] != 0;
    p.depth_m = static_cast<double>(image_of(frame_, Aov::kDepth).floats[i]);
    p.triangle = image_of(frame_, Aov::kIdTriangle).uints[i];
    p.position = vector_in(image_of(frame_, Aov::kPosition), i);
    p.hit_kind = static_cast<HitKind>(image_of(frame_, Aov::kHitKind).uints[i]);
    p.hit_id = image_of(frame_, Aov::kHitId).uints[i];
    p.hit_position = vector_in(image_of(frame_, Aov::kHitPosition), i);
    return p;
  }

 private:
  const Frame& frame_;
};

struct Tally {
  long pixels = 0, water = 0, mirrored = 0, differ = 0, elsewhere = 0, ghosts = 0, not_silhouette = 0;
  double position = 0, hit = 0, depth = 0;  // worst, of pixels that agree: in units of the stated bounds
  std::ostringstream notes;
};

std::string text(const OraclePixel& p) {
  std::ostringstream out;
  out << (p.water ? "water" : "triangle ") << (p.water ? "" : std::to_string(p.triangle)) << ", kind "
      << static_cast<int>(p.hit_kind) << ", id " << p.hit_id << ", at " << p.hit_position.x << " " << p.hit_position.y
      << " " << p.hit_position.z;
  return out.str();
}

// Does the reference show the same as `shown` anywhere within a pixel? Halves what lies between any two points that
// show different things, so that bands far thinner than its first steps (at the edge of Snell's window) are found too.
struct SilhouetteSearch {
  const RefractionOracle& oracle;
  const Camera& camera;
  double x, y;

  OraclePixel at(double angle, double r) const {
    return oracle.trace(camera, kWidth, kHeight, x + r * std::cos(angle), y + r * std::sin(angle));
  }
  bool between(const OraclePixel& shown, double angle, double r0, const OraclePixel& p0, double r1,
               const OraclePixel& p1, int depth) const {
    if (p0.shows_the_same(p1) || depth == 0) return false;
    const double r = 0.5 * (r0 + r1);
    const OraclePixel p = at(angle, r);
    return p.shows_the_same(shown) || between(shown, angle, r0, p0, r, p, depth - 1) ||
           between(shown, angle, r, p, r1, p1, depth - 1);
  }
  bool finds(const OraclePixel& shown) const {
    constexpr int kAngles = 32, kSteps = 8, kHalvings = 14;
    for (int k = 0; k < kAngles; ++k) {
      const double angle = 6.283185307179586 * k / kAngles;
      OraclePixel last = at(angle, 0);
      for (int i = 1; i <= kSteps; ++i) {
        const double r0 = (i - 1.0) / kSteps, r1 = static_cast<double>(i) / kSteps;
        const OraclePixel next = at(angle, r1);
        if (next.shows_the_same(shown) || between(shown, angle, r0, last, r1, next, kHalvings)) return true;
        last = next;
      }
    }
    return false;
  }
  // Does what is seen change its kind within half a pixel (the edge of Snell's window, of the water, of the scene)?
  bool kind_changes() const {
    const OraclePixel here = at(0, 0);
    for (int k = 0; k < 32; ++k) {
      const OraclePixel there = at(6.283185307179586 * k / 32, 0.5);
      if (there.hit_kind != here.hit_kind || there.water != here.water) return true;
    }
    return false;
  }
};

// Bounds where the primitive agrees, with L the way from the eye to the point plus the size of the coordinates and s
// the steepness of the oracle: both points 2e-7 L / s. Depth moves by the snapping of the corners too: by what 0.004 px
// move the point on its plane.
void compare(const RenderScene& scene, const RefractionOracle& oracle, const Camera& camera, const std::string& method,
             Tally& tally) {
  FrameSettings settings;
  settings.method = method;
  settings.width_px = kWidth, settings.height_px = kHeight;
  settings.isa = supported_isas().front();
  settings.threads = 2;
  settings.aovs = (1u << static_cast<unsigned>(Aov::kCount)) - 1u;
  Renderer renderer(scene, settings);
  Frame frame;
  renderer.render(camera, 0.0, frame);
  const FramePixels pixels(frame);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const OraclePixel truth = oracle.trace(camera, kWidth, kHeight, x + 0.5, y + 0.5), shown = pixels.at(x, y);
      ++tally.pixels;
      tally.water += truth.water;
      tally.mirrored += truth.hit_kind == HitKind::kMirror;
      const double size = truth.path_m + norm_of(as_double(camera.position_world)) + 1.0;
      const double bound = 2e-7 * size / truth.steepness,
                   hit_bound = 2e-7 * size / (truth.steepness * truth.hit_steepness);
      if (shown.shows_the_same(truth)) {
        if (truth.triangle == kNothing && !truth.water) continue;
        tally.position = std::max(tally.position, norm_of(shown.position - truth.position) / bound);
        const double per_px = camera.orthographic
                                  ? 2.0 * static_cast<double>(camera.xmag_m) / kWidth
                                  : truth.depth_m * 2.0 * static_cast<double>(camera.tan_half_yfov) / kHeight;
        const double depth_bound = 0.004 * per_px / truth.steepness + 2e-6 * size;
        tally.depth = std::max(tally.depth, std::fabs(shown.depth_m - truth.depth_m) / depth_bound);
        if (truth.hit_id != kNothing)
          tally.hit = std::max(tally.hit, norm_of(shown.hit_position - truth.hit_position) / hit_bound);
        continue;
      }
      ++tally.differ;
      // A neighbour across a shared edge shows the same point; the rest is a real difference.
      const bool same_point = shown.water == truth.water && shown.hit_kind == truth.hit_kind &&
                              norm_of(shown.position - truth.position) <= 10 * bound &&
                              norm_of(shown.hit_position - truth.hit_position) <= 10 * hit_bound;
      tally.elsewhere += !same_point;
      const SilhouetteSearch search{oracle, camera, x + 0.5, y + 0.5};
      if (same_point || search.finds(shown)) continue;
      // Seen almost edge-on, the image of a triangle may turn its other side within the broad phase's quarter pixel.
      if (search.kind_changes()) {
        ++tally.ghosts;
        continue;
      }
      ++tally.not_silhouette;
      tally.notes << "pixel " << x << "," << y << ": shows " << text(shown) << "; truth " << text(truth) << "\n";
    }
}

std::vector<std::pair<std::string, Camera>> cameras_of(const RenderScene& scene, bool box) {
  std::vector<std::pair<std::string, Camera>> out;
  for (const PlacedCamera& c : scene.cameras) out.emplace_back(c.name, c.camera);
  if (!box) return out;
  out.emplace_back("straight down", camera_at({0.05f, 1.6f, 0.02f}, {0, -0.8f, 0}, 0.9));
  out.emplace_back("at the surface", camera_at({0.85f, 0.004f, 0.5f}, {-0.6f, -0.05f, -0.2f}, 1.0));
  out.emplace_back("just under", camera_at({0.85f, -0.01f, 0.5f}, {-0.6f, 0.0f, -0.2f}, 1.0));
  out.emplace_back("up from the floor", camera_at({0.1f, -0.75f, 0.1f}, {0, 0.5f, 0}, 1.9));
  Camera above = camera_at({1.5f, 1.4f, 1.2f}, {0, -0.2f, 0}, 1.0);
  above.orthographic = true, above.xmag_m = 1.8f, above.ymag_m = 1.2f, above.near_m = 0.01f, above.far_m = 20;
  out.emplace_back("orthographic", above);
  Camera below = camera_at({0.3f, -0.7f, 0.2f}, {0.0f, 0.0f, 0.0f}, 1.0);
  below.orthographic = true, below.xmag_m = 0.5f, below.ymag_m = 0.33f, below.near_m = 0.0f, below.far_m = 20;
  out.emplace_back("orthographic from below", below);
  return out;
}

void check_scene(const std::string& name, std::uint64_t triangles, double share, double share_elsewhere) {
  const RenderScene scene = built_in(name, triangles);
  for (const std::string method : {"hybrid", "none", "ray-traced"}) {
    const RefractionOracle oracle(scene, method != "none");
    for (const auto& [camera_name, camera] : cameras_of(scene, name == "box")) {
      Tally t;
      compare(scene, oracle, camera, method, t);
      const double pixels = static_cast<double>(t.pixels), differ = static_cast<double>(t.differ),
                   elsewhere = static_cast<double>(t.elsewhere);
      INFO(name << ", " << method << ", " << camera_name << ": " << t.water << " water pixels, " << t.mirrored
                << " mirrored, " << t.differ << " differ, " << t.elsewhere << " of them in their point, " << t.ghosts
                << " ghosts\n"
                << t.notes.str());
      CAPTURE(t.position, t.hit, t.depth);
      CHECK(t.water > 50);
      CHECK(t.not_silhouette == 0);
      // Rays differ where a path passes an edge within rounding, no more.
      const bool traced = method == "ray-traced";
      CHECK(static_cast<double>(t.ghosts) <= (traced ? 0.0 : 0.001 * pixels));
      CHECK(differ <= (traced ? 0.0005 : share) * pixels);
      CHECK(elsewhere <= (traced ? 0.0002 : share_elsewhere) * pixels);
      CHECK(t.position < 1);
      CHECK(t.hit < 1);
      CHECK(t.depth < 1);
    }
  }
}

}  // namespace

TEST_CASE("box: every pixel as brute force in double shows it, or a silhouette") {
  check_scene("box", 600, 0.0025, 0.0025);
}

TEST_CASE("pool: every pixel as brute force in double shows it, or a silhouette") {
  check_scene("pool", 2000, 0.0075, 0.0075);
}
