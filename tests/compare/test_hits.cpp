// The hit metrics on frames made by hand, whose answers are known.
#include <catch2/catch.hpp>
#include <cmath>

#include "compare/hits.h"
#include "compare/yee.h"
#include "core/error.h"

namespace shoal::test {
namespace {

constexpr int kWidth = 4, kHeight = 2;

// Two objects of ten triangles each under water; two bodies of it, planes y = 0 and y = 1.
RenderScene make_scene() {
  RenderScene scene;
  for (std::uint32_t i = 0; i < 2; ++i) {
    Drawable d;
    d.node = 5;  // of one node: the primitive tells them apart
    d.primitive = i;
    d.first_triangle = 10 * i;
    d.triangle_count = 10;
    scene.geometry.drawables.push_back(d);
  }
  for (const float height : {0.0f, 1.0f}) {
    WaterBody body;
    body.origin = {0, height, 0};
    scene.waters.push_back(body);
  }
  return scene;
}

// Straight down from 10 m; orthographic: 100 px a metre across. Right is +x, the frame's up is -z.
Camera looking_down(bool orthographic) {
  Camera camera;
  camera.position_world = {0, 10, 0};
  camera.forward_world = {0, -1, 0};
  camera.up_world = {0, 0, -1};
  camera.right_world = {1, 0, 0};
  camera.orthographic = orthographic;
  camera.xmag_m = 0.02f;
  camera.ymag_m = 0.01f;
  camera.tan_half_yfov = 0.01f;  // 100 px a metre at a depth of 1 m
  return camera;
}

Frame make_frame() {
  Frame frame;
  frame.width_px = kWidth;
  frame.height_px = kHeight;
  const std::size_t n = kWidth * kHeight;
  frame.aovs.push_back({Aov::kWaterMask, 1, {}, std::vector<std::uint32_t>(n, 0)});
  frame.aovs.push_back({Aov::kHitKind, 1, {}, std::vector<std::uint32_t>(n, 0)});
  frame.aovs.push_back({Aov::kHitPosition, 3, std::vector<float>(3 * n, 0.0f), {}});
  frame.aovs.push_back({Aov::kHitId, 1, {}, std::vector<std::uint32_t>(n, kNoTriangle)});
  frame.aovs.push_back({Aov::kHitSecondary, 1, {}, std::vector<std::uint32_t>(n, 0)});
  return frame;
}

void show(Frame& frame, std::size_t pixel, HitKind kind, Vec3f position, std::uint32_t triangle, unsigned body = 1) {
  frame.aovs[0].uints[pixel] = body;
  frame.aovs[1].uints[pixel] = static_cast<std::uint32_t>(kind);
  frame.aovs[2].floats[3 * pixel] = position.x;
  frame.aovs[2].floats[3 * pixel + 1] = position.y;
  frame.aovs[2].floats[3 * pixel + 2] = position.z;
  frame.aovs[3].uints[pixel] = triangle;
}

}  // namespace

TEST_CASE("hits: a frame is like itself", "[hits]") {
  Frame frame = make_frame();
  show(frame, 0, HitKind::kSurface, {0.1f, -1, 0.2f}, 3);
  show(frame, 1, HitKind::kSky, {0, 0, 0}, kNoTriangle);
  show(frame, 2, HitKind::kMirror, {0.1f, -2, 0.2f}, 13);
  show(frame, 3, HitKind::kMiss, {0, 0, 0}, kNoTriangle);
  const HitComparison c = compare_hits(make_scene(), looking_down(true), frame, frame);
  CHECK(c.water_pixels == 4);
  CHECK(c.compared_pixels == 1);
  CHECK(c.error_px.median == 0);
  CHECK(c.error_m.p99 == 0);
  CHECK(c.wrong_object == 0);
  CHECK(c.wrong_surface == 0);
  CHECK(c.water == PixelMask{true, true, true, true, false, false, false, false});
  CHECK(c.error_map_px[0] == 0.0f);
  CHECK(c.error_map_px[1] == -1.0f);
}

TEST_CASE("hits: objects, kinds and distances", "[hits]") {
  Frame truth = make_frame(), method = make_frame();
  const Vec3f p{0.01f, -1, 0.02f};
  const auto both = [&](std::size_t pixel, HitKind kind, std::uint32_t id, HitKind other, std::uint32_t other_id,
                        float off_m) {
    show(truth, pixel, kind, p, id);
    show(method, pixel, other, {p.x + off_m, p.y, p.z}, other_id);
  };
  both(0, HitKind::kSurface, 0, HitKind::kSurface, 9, 0.09f);        // another triangle of the object, 9 cm off: right
  both(1, HitKind::kSurface, 9, HitKind::kSurface, 10, 0.0f);        // the next object
  both(2, HitKind::kSurface, 19, HitKind::kSurface, 19, 0.11f);      // 11 cm off
  both(3, HitKind::kSurface, 0, HitKind::kMiss, kNoTriangle, 0.0f);  // a miss
  both(4, HitKind::kSky, kNoTriangle, HitKind::kSurface, 0, 0.0f);   // another kind
  both(5, HitKind::kMirror, 0, HitKind::kMirror, 0, 0.5f);           // a mirrored point, half a metre off
  both(6, HitKind::kSky, kNoTriangle, HitKind::kSky, kNoTriangle, 1);  // the sky is the sky
  show(method, 7, HitKind::kSurface, p, 0);                            // no water in the reference: not counted
  // Two of the seven cross a secondary interface in the reference: one that is wrong and one that is right.
  truth.aovs[4].uints[3] = truth.aovs[4].uints[6] = 1;
  method.aovs[4].uints[0] = 1;  // what the method crosses does not count
  const HitComparison c = compare_hits(make_scene(), looking_down(true), truth, method);
  CHECK(c.secondary_share == Approx(2.0 / 7));
  CHECK(c.wrong_object_primary == Approx(2.0 / 5));   // 1, 4
  CHECK(c.wrong_surface_primary == Approx(3.0 / 5));  // 2, 4, 5
  CHECK(c.water_pixels == 7);
  CHECK(c.compared_pixels == 3);
  CHECK(c.wrong_object == Approx(3.0 / 7));   // 1, 3, 4
  CHECK(c.wrong_surface == Approx(4.0 / 7));  // 2, 3, 4, 5
  CHECK(c.wrong[0] == 0);
  CHECK(c.wrong[1] == HitComparison::kWrongObject);
  CHECK(c.wrong[2] == HitComparison::kWrongSurface);
  CHECK((c.wrong[4] & HitComparison::kWrongKind) != 0);
  CHECK(c.error_m.median == Approx(0.09).margin(1e-6));  // of 0, 0.09, 0.11
  CHECK(c.error_m.p99 == Approx(0.11).margin(1e-6));
  // Seen straight down by parallel rays, refraction moves nothing sideways: 100 px a metre.
  CHECK(c.error_px.median == Approx(9).margin(1e-3));
  CHECK(c.error_px.p95 == Approx(11).margin(1e-3));
  CHECK(c.error_map_px[2] == Approx(11).margin(1e-3));
  CHECK(c.error_map_px[7] == -1.0f);
}

TEST_CASE("hits: pixels are those of the refracted picture", "[hits]") {
  // Under the eye a point 2.666 m down appears 2 m down, 12 m away: a centimetre beside the axis is 100 / 12 of 0.01
  // px. The second body's plane is a metre higher: 3.666 m down, seen 2.7502 m down, 9 + 2.7502 m away.
  RenderScene scene = make_scene();
  Frame truth = make_frame(), method = make_frame();
  for (std::size_t i = 0; i < 2; ++i) {
    show(truth, i, HitKind::kSurface, {0, -2.666f, 0}, 0, static_cast<unsigned>(i) + 1);
    show(method, i, HitKind::kSurface, {0.01f, -2.666f, 0}, 0, static_cast<unsigned>(i) + 1);
  }
  const HitComparison c = compare_hits(scene, looking_down(false), truth, method);
  CHECK(c.error_map_px[0] == Approx(1.0 / 12).epsilon(1e-4));
  CHECK(c.error_map_px[1] == Approx(1.0 / (9 + 3.666 / 1.333)).epsilon(1e-4));
  // An error along the line of sight is none on the screen.
  show(method, 0, HitKind::kSurface, {0, -2, 0}, 0);
  CHECK(compare_hits(scene, looking_down(false), truth, method).error_map_px[0] == Approx(0).margin(1e-6));
  // What maps to behind the camera is a frame's diagonal off.
  show(method, 0, HitKind::kSurface, {0, 11, 0}, 0);
  CHECK(compare_hits(scene, looking_down(false), truth, method).error_map_px[0] == Approx(std::sqrt(20.0)));
}

TEST_CASE("hits: no water, no buffers, other sizes", "[hits]") {
  const Frame frame = make_frame();
  const HitComparison c = compare_hits(make_scene(), looking_down(true), frame, frame);
  CHECK(c.water_pixels == 0);
  CHECK(std::isnan(c.wrong_object));
  CHECK(std::isnan(c.error_px.median));
  Frame bare = frame;
  bare.aovs.pop_back();
  CHECK_THROWS_AS(compare_hits(make_scene(), looking_down(true), frame, bare), UsageError);
  Frame other = frame;
  other.width_px = 8;
  CHECK_THROWS_AS(compare_hits(make_scene(), looking_down(true), frame, other), UsageError);
}

TEST_CASE("yee: equal pictures, and a square that is not", "[yee]") {
  LinearPicture a{64, 64, std::vector<float>(64 * 64 * 3, 0.5f)};
  LinearPicture b = a;
  CHECK(yee_failed_pixels(a, b, {}, 45, 1) == 0);
  PixelMask outside(64 * 64, true);
  for (std::size_t y = 20; y < 40; ++y) {
    for (std::size_t x = 20; x < 40; ++x) {
      b.rgb[(y * 64 + x) * 3] = 0.9f;  // red only: see yee.h
      outside[y * 64 + x] = false;
    }
  }
  CHECK(yee_failed_pixels(a, b, {}, 45, 1) >= 300);
  CHECK(yee_failed_pixels(a, b, outside, 45, 1) == 0);
}

}  // namespace shoal::test
