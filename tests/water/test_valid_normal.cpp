// valid_normal against a search over all normals in double.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "water/valid_normal.h"

namespace {

using namespace shoal;

Vec3d to_double(Vec3f v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }
Vec3d unit(Vec3d v) { return v * (1 / std::sqrt(dot(v, v))); }

struct Ways {
  bool faces, refracts;
  Vec3d refracted, reflected;
};

// Snell's law by vectors along and across the normal.
Ways ways(Vec3d d, Vec3d n, double eta) {
  Ways w = {dot(d, n) < 0, false, {0, 0, 0}, d - n * (2 * dot(d, n))};
  const Vec3d across = (d - n * dot(d, n)) * eta;
  const double left = 1 - dot(across, across);
  w.refracts = left > 0;
  if (w.refracts) w.refracted = across - n * std::sqrt(left);
  return w;
}

struct Margins {
  double back, through;
};
Margins margins(Vec3d d, Vec3d plane, double eta) {
  const Ways flat = ways(d, plane, eta);
  const double most = static_cast<double>(kLeavingMargin);
  return {std::min(most, -0.5 * dot(d, plane)),
          flat.refracts ? std::min(most, -0.5 * dot(flat.refracted, plane)) : most};
}

// By how much a normal fails; at most 0 is valid.
double failure(Vec3d d, Vec3d plane, Vec3d n, double eta) {
  const Ways w = ways(d, n, eta);
  const Margins m = margins(d, plane, eta);
  if (!w.faces) return 1;
  const double back = m.back - dot(w.reflected, plane);
  return w.refracts ? std::max(back, dot(w.refracted, plane) + m.through) : back;
}

// So near the critical angle that rounding decides whether there is a refracted ray.
bool critical(Vec3d d, Vec3d n, double eta) {
  const Vec3d across = (d - n * dot(d, n)) * eta;
  return std::fabs(1 - dot(across, across)) < 1e-5;
}

struct Input {
  Vec3f d, wave;
};
Input random_input(std::mt19937& random, float steepness) {
  const auto s = [&] { return static_cast<float>(static_cast<std::int32_t>(random()) >> 8) * 0x1p-23f; };
  const float down = std::fabs(s());
  const Vec3f d = normalize(Vec3f{s(), -down * down - 1e-4f, s()});
  return {d, normalize(Vec3f{steepness * s(), 1, steepness * s()})};
}

const Vec3f kPlane = {0, 1, 0};

}  // namespace

TEST_CASE("valid normals stay as they are, invalid ones become valid", "[water]") {
  std::mt19937 random(21);
  int bent = 0, given_up = 0;
  for (const float eta : {0.4f, 0.75f, 1.0f, 1.333f, 1.5f, 2.5f}) {
    for (const float steepness : {0.1f, 0.5f, 2.0f}) {
      for (int i = 0; i < 20000; ++i) {
        const Input in = random_input(random, steepness);
        const Vec3f got = valid_normal(in.d, kPlane, in.wave, eta);
        const Vec3d d = unit(to_double(in.d)), plane = to_double(kPlane);
        const double e = static_cast<double>(eta), before = failure(d, plane, to_double(in.wave), e);
        const double after = failure(d, plane, unit(to_double(got)), e);
        if (critical(d, to_double(in.wave), e) || critical(d, unit(to_double(got)), e)) continue;
        CAPTURE(eta, steepness, i, in.d.x, in.d.y, in.d.z, in.wave.x, in.wave.y, in.wave.z, got.x, got.y, got.z,
                before);
        REQUIRE(std::fabs(dot(got, got) - 1) < 1e-6f);
        const bool same = got.x == in.wave.x && got.y == in.wave.y && got.z == in.wave.z;
        if (before < -1e-6) REQUIRE(same);
        if (before > 1e-6) REQUIRE(!same);
        // At least half of either margin.
        const Margins m = margins(d, plane, e);
        REQUIRE(after < 0.51 * std::max(m.back, m.through));
        bent += same ? 0 : 1;
        given_up += !same && got.x == 0.0f && got.z == 0.0f ? 1 : 0;
      }
    }
  }
  CAPTURE(bent, given_up);
  CHECK(bent > 20000);
  CHECK(given_up < bent / 1000);
}

TEST_CASE("a flat surface keeps its normal at every angle", "[water]") {
  for (const float eta : {0.4f, 0.75f, 1.0f, 1.333f, 2.5f}) {
    for (int i = 1; i < 20000; ++i) {
      const float y = static_cast<float>(i) / 20000.0f;
      const Vec3f d = {std::sqrt(1 - y * y), -y, 0};
      const Vec3f got = valid_normal(d, kPlane, kPlane, eta);
      CAPTURE(eta, y);
      REQUIRE(got.y == 1.0f);
    }
  }
}

TEST_CASE("the ray leaves in the valid direction nearest to the wave's own", "[water]") {
  std::mt19937 random(22);
  int searched = 0;
  for (const float eta : {0.75f, 1.333f}) {
    const double e = static_cast<double>(eta);
    for (int tries = 0; tries < 100000 && searched < (eta < 1 ? 30 : 60); ++tries) {
      const Input in = random_input(random, 0.5f);
      const Vec3d d = unit(to_double(in.d)), plane = to_double(kPlane), wave = to_double(in.wave);
      const Ways own = ways(d, wave, e);
      if (!own.faces || failure(d, plane, wave, e) < 1e-6) continue;
      const Vec3d got = unit(to_double(valid_normal(in.d, kPlane, in.wave, eta)));
      const bool refraction = own.refracts && dot(own.refracted, plane) > -margins(d, plane, e).through;
      const auto miss = [&](const Ways& w) {
        const Vec3d off = refraction ? w.refracted - own.refracted : w.reflected - own.reflected;
        return refraction && !w.refracts ? 4.0 : std::sqrt(dot(off, off));
      };
      const double ours = miss(ways(d, got, e));
      // All normals on the plane's side, ever closer about the best.
      double best = 4, at_x = 0, at_z = 0;
      for (double span = 1.0; span > 1e-6; span *= 0.6) {
        const double cx = at_x, cz = at_z;
        for (int j = -40; j <= 40; ++j) {
          for (int i = -40; i <= 40; ++i) {
            const double x = cx + span * i / 40, z = cz + span * j / 40;
            if (x * x + z * z >= 1) continue;
            const Vec3d n = {x, std::sqrt(1 - x * x - z * z), z};
            if (failure(d, plane, n, e) > 0) continue;
            const double there = miss(ways(d, n, e));
            if (there < best) best = there, at_x = x, at_z = z;
          }
        }
      }
      CAPTURE(eta, refraction, ours, best, in.d.x, in.d.y, in.d.z, in.wave.x, in.wave.y, in.wave.z);
      REQUIRE(best < 4);
      REQUIRE(ours < best + 1e-4);
      ++searched;
    }
  }
  CHECK(searched == 60);
}
