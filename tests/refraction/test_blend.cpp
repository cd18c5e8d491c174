// Blended materials against sorting and compositing in double, pixel by pixel.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include "../raster/coverage_oracle.h"
#include "blend_scene.h"

using namespace shoal_test;

namespace {

constexpr int kWidth = 61, kHeight = 83;
constexpr Vec3f kBehind{0.25f, 0.5f, 0.125f};

// One unit of the world is a pixel, one 1/256 of it a step of the grid: nothing is rounded when corners are snapped.
Camera pixel_camera() {
  Camera c;
  c.orthographic = true;
  c.xmag_m = 0.5f * static_cast<float>(kWidth), c.ymag_m = 0.5f * static_cast<float>(kHeight);
  c.near_m = 1.0f, c.far_m = 1025.0f;
  return c;
}

FrameSettings settings_of(int threads = 2) {
  FrameSettings s;
  s.width_px = kWidth, s.height_px = kHeight;
  s.isa = supported_isas().front();
  s.threads = threads;
  s.keep_linear = true;
  return s;
}

// Grid position and depth in metres to world.
Vec3f place(std::int64_t x, std::int64_t y, int depth_m) {
  return {static_cast<float>(x) / 256.0f - 0.5f * static_cast<float>(kWidth),
          0.5f * static_cast<float>(kHeight) - static_cast<float>(y) / 256.0f, -static_cast<float>(depth_m)};
}

struct Expected {
  double rgb[3], alpha;
  int layers;
  bool doubtful;  // two surfaces nearer to each other than the depth buffer's rounding
};

class Oracle {
 public:
  explicit Oracle(std::vector<Sheet> sheets) : sheets_(std::move(sheets)) {
    for (const Sheet& s : sheets_)
      for (std::size_t i = 0; i < s.corners.size(); i += 3) {
        Piece p{{}, {}, &s};
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3f c = s.corners[i + k];
          p.grid.x[k] = std::llround((static_cast<double>(c.x) + 0.5 * kWidth) * 256);
          p.grid.y[k] = std::llround((0.5 * kHeight - static_cast<double>(c.y)) * 256);
          p.z[k] = -static_cast<double>(c.z);
        }
        pieces_.push_back(p);
      }
  }

  Expected at(int x, int y) const {
    struct Fragment {
      double z;
      std::size_t id;
    };
    std::vector<Fragment> fragments;
    for (std::size_t id = 0; id < pieces_.size(); ++id) {
      const Piece& p = pieces_[id];
      if (!covers(p.grid, x, y) || (!p.sheet->two_sided && !faces_viewer(p.grid))) continue;
      fragments.push_back({depth(p, x, y), id});
    }
    std::sort(fragments.begin(), fragments.end(),
              [](const Fragment& a, const Fragment& b) { return a.z < b.z || (a.z == b.z && a.id < b.id); });
    Expected e{{kBehind.x, kBehind.y, kBehind.z}, 0, 0, false};
    for (std::size_t i = 1; i < fragments.size(); ++i) {
      const double gap = fragments[i].z - fragments[i - 1].z;
      e.doubtful = e.doubtful || (gap > 0 && gap < 2e-3);
    }
    std::size_t end = 0;
    while (end < fragments.size() && pieces_[fragments[end].id].sheet->blended) ++end;
    if (end < fragments.size()) over(e, *pieces_[fragments[end].id].sheet, 1);
    e.layers = static_cast<int>(end);
    for (std::size_t i = end; i-- > 0;) {
      const Sheet& s = *pieces_[fragments[i].id].sheet;
      over(e, s, static_cast<double>(s.color.w));
    }
    return e;
  }

 private:
  struct Piece {
    GridTriangle grid;
    double z[3];
    const Sheet* sheet;
  };
  static void over(Expected& e, const Sheet& s, double a) {
    const float rgb[3] = {s.color.x, s.color.y, s.color.z};
    for (int c = 0; c < 3; ++c) e.rgb[c] = e.rgb[c] * (1 - a) + static_cast<double>(rgb[c]) * a;
    e.alpha = e.alpha * (1 - a) + a;
  }
  static double depth(const Piece& p, int x, int y) {
    const auto area = [&](int a, int b, std::int64_t px, std::int64_t py) {
      return static_cast<double>(side_of(p.grid, a, b, px, py));
    };
    const std::int64_t px = x * 256 + 128, py = y * 256 + 128;
    const double all = area(0, 1, p.grid.x[2], p.grid.y[2]);
    return (p.z[0] * area(1, 2, px, py) + p.z[1] * area(2, 0, px, py) + p.z[2] * area(0, 1, px, py)) / all;
  }

  std::vector<Sheet> sheets_;
  std::vector<Piece> pieces_;
};

struct Tally {
  int checked = 0, doubtful = 0, most_layers = 0;
};

Tally check(const std::vector<Sheet>& sheets, const Frame& frame) {
  const Oracle oracle(sheets);
  Tally tally;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Expected e = oracle.at(x, y);
      if (e.doubtful) {
        ++tally.doubtful;
        continue;
      }
      ++tally.checked;
      tally.most_layers = std::max(tally.most_layers, e.layers);
      // Each layer rounds its weight, its product and its sum, each of at most 1.
      const double bound = 3.0 * (e.layers + 1) * 0x1p-24;
      const float* got = frame.linear.data() + 4 * static_cast<std::size_t>(y * kWidth + x);
      for (int c = 0; c < 3; ++c) {
        if (std::fabs(static_cast<double>(got[c]) - e.rgb[c]) <= bound) continue;
        FAIL_CHECK("pixel " << x << ", " << y << " channel " << c << ": " << got[c] << ", expected " << e.rgb[c]
                            << " of " << e.layers << " layers");
        return tally;
      }
      if (std::fabs(static_cast<double>(got[3]) - e.alpha) > bound) {
        FAIL_CHECK("pixel " << x << ", " << y << " alpha: " << got[3] << ", expected " << e.alpha);
        return tally;
      }
    }
  return tally;
}

Frame draw(const std::vector<Sheet>& sheets) {
  return render_scene(build_render_scene(scene_of(sheets, kBehind)), pixel_camera(), settings_of());
}

class Random {
 public:
  explicit Random(std::uint32_t seed) : bits_(seed) {}
  int below(int n) { return static_cast<int>(bits_() % static_cast<std::uint32_t>(n)); }
  Vec4f color(float least_alpha) {
    const auto eighth = [&] { return static_cast<float>(below(65)) / 64.0f; };
    return {eighth(), eighth(), eighth(), least_alpha + (1.0f - least_alpha) * static_cast<float>(below(64)) / 64.0f};
  }

 private:
  std::mt19937 bits_;
};

// Steep triangles of all sizes that run through each other, reaching out of the frame.
std::vector<Sheet> tangle(int count, std::uint32_t seed, int opaque_every) {
  Random random(seed);
  std::vector<Sheet> sheets;
  for (int i = 0; i < count; ++i) {
    Sheet s;
    const int size = 8 << random.below(4);
    const int cx = random.below(kWidth), cy = random.below(kHeight);
    for (int k = 0; k < 3; ++k) {
      const int depth_m = 20 + random.below(900);
      const int y = (cy - size) * 256 + random.below(size * 512), x = (cx - size) * 256 + random.below(size * 512);
      s.corners.push_back(place(x, y, depth_m));
    }
    s.color = random.color(0.1f);
    s.blended = opaque_every == 0 || i % opaque_every != 0;
    s.two_sided = i % 3 != 0;
    sheets.push_back(s);
  }
  return sheets;
}

Sheet whole_frame_at(int depth_m, Vec4f color, bool blended = true) {
  const std::int64_t r = kWidth * 256, b = kHeight * 256;
  return quad(place(0, 0, depth_m), place(0, b, depth_m), place(r, b, depth_m), place(r, 0, depth_m), color, blended);
}

}  // namespace

TEST_CASE("blend: triangles that run through each other, sorted and composited in double", "[blend]") {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    const std::vector<Sheet> sheets = tangle(90, seed, seed % 2 ? 11 : 0);
    const Tally tally = check(sheets, draw(sheets));
    CHECK(tally.checked > kWidth * kHeight * 95 / 100);
    CHECK(tally.most_layers > 8);
  }
}

TEST_CASE("blend: more layers than a round holds", "[blend]") {
  std::vector<Sheet> sheets = tangle(300, 7, 0);
  for (Sheet& s : sheets) s.color.w *= 0.1f;
  Random random(8);
  for (int i = 0; i < 120; ++i) {
    Vec4f color = random.color(0.0f);
    color.w *= 0.05f;
    sheets.push_back(whole_frame_at(30 + 7 * i, color));
  }
  std::reverse(sheets.begin(), sheets.begin() + 200);
  const Tally tally = check(sheets, draw(sheets));
  CHECK(tally.most_layers > 4 * 32);
  CHECK(tally.checked > kWidth * kHeight / 2);
}

TEST_CASE("blend: exactly as many layers as a round holds, and one more", "[blend]") {
  for (const int count : {31, 32, 33, 64, 65}) {
    CAPTURE(count);
    std::vector<Sheet> sheets;
    Random random(static_cast<std::uint32_t>(count));
    for (int i = 0; i < count; ++i) {
      Vec4f color = random.color(0.0f);
      color.w = 0.0625f;
      sheets.push_back(whole_frame_at(500 - 3 * ((i * 29) % 131), color));
    }
    CHECK(check(sheets, draw(sheets)).most_layers == count);
  }
}

TEST_CASE("blend: at equal depth the earlier triangle is the nearer one", "[blend]") {
  const Vec4f red{1, 0, 0, 0.5f}, green{0, 1, 0, 0.5f}, blue{0, 0, 1, 0.75f}, white{1, 1, 1, 1};
  const std::vector<std::vector<Sheet>> cases = {
      {whole_frame_at(100, red), whole_frame_at(100, green), whole_frame_at(100, blue)},
      {whole_frame_at(100, blue), whole_frame_at(100, green), whole_frame_at(100, red)},
      // An opaque one counts alike: it hides what comes later, and is seen through what came earlier.
      {whole_frame_at(100, red), whole_frame_at(100, white, false), whole_frame_at(100, green)},
      {whole_frame_at(100, white, false), whole_frame_at(100, red)},
  };
  const Frame first = draw(cases[0]), second = draw(cases[1]);
  CHECK(first.linear != second.linear);
  for (const std::vector<Sheet>& sheets : cases) {
    const Tally tally = check(sheets, draw(sheets));
    CHECK(tally.checked == kWidth * kHeight);
  }
}

TEST_CASE("blend: the same picture whatever the order of the file", "[blend]") {
  std::vector<Sheet> sheets = tangle(120, 21, 9);
  const Frame forward = draw(sheets);
  std::reverse(sheets.begin(), sheets.end());
  CHECK(draw(sheets).linear == forward.linear);
}

TEST_CASE("blend: depth, ids and the like are those of the opaque scene", "[blend]") {
  std::vector<Sheet> sheets = tangle(40, 31, 1);
  FrameSettings settings = settings_of();
  settings.aovs = (1u << static_cast<int>(Aov::kCount)) - 1u;
  const Frame bare = render_scene(build_render_scene(scene_of(sheets, kBehind)), pixel_camera(), settings);
  for (const Sheet& s : tangle(40, 32, 0)) sheets.push_back(s);
  const Frame blended = render_scene(build_render_scene(scene_of(sheets, kBehind)), pixel_camera(), settings);
  CHECK(bare.linear != blended.linear);
  REQUIRE(bare.aovs.size() == blended.aovs.size());
  for (std::size_t i = 0; i < bare.aovs.size(); ++i) {
    CHECK(bare.aovs[i].floats == blended.aovs[i].floats);
    CHECK(bare.aovs[i].uints == blended.aovs[i].uints);
  }
}

TEST_CASE("blend: only scenes with blended materials have the stage", "[blend]") {
  FrameSettings settings = settings_of();
  settings.digests = true;
  const auto has_stage = [&](int opaque_every) {
    const RenderScene scene = build_render_scene(scene_of(tangle(20, 5, opaque_every), kBehind));
    const Frame frame = render_scene(scene, pixel_camera(), settings);
    return std::any_of(frame.digests.begin(), frame.digests.end(), [](const auto& d) { return d.first == "blended"; });
  };
  CHECK(has_stage(0));
  CHECK_FALSE(has_stage(1));
}
