// The operations of GLM that code which reaches a pixel may use, each against its written-out expression, bit for bit,
// for one number and for sixteen lanes; and those that it must not use, each with inputs for which it differs.
//
//   may be used    constructors from components and from vectors of other lengths or component types; x, y, z, w;
//                  v[i], m[column]; unary -, + and - and * and / of two vectors, v * s, s * v, v / s; ==, !=;
//                  a matrix from its columns, from its components and from one diagonal number
//   must not be    everything else. dot, cross, length, normalize, lerp, min, max, select (core/vec.h,
//   core/vec_lanes.h),
//                  transform_point, transform_direction (core/matrix.h), product, inverse and from_trs
//                  (scene/build/transform.h) are Shoal's own
//
// tests/structure/glm_functions.sh rejects calls of any function of GLM in the rooms whose code reaches a pixel.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>

// All of GLM before Shoal's headers: a user's program may do so, and Shoal's functions must still be the ones called.
#include <glm/glm.hpp>

#include "core/matrix.h"
#include "core/vec_lanes.h"
#include "scene/build/transform.h"
#include "tests/core/isa_case.h"

using namespace shoal;

namespace {

constexpr int kRounds = 4000;

bool same(float a, float b) {
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
template <class F>
bool same(const Vec3<F>& a, const Vec3<F>& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}
bool same(const WideF& a, const std::array<float, 16>& b) {
  float lanes[16];
  a.store(lanes);
  for (std::size_t i = 0; i < 16; ++i) {
    if (!same(lanes[i], b[i])) return false;
  }
  return true;
}

class Source {
 public:
  // Any float: denormals, infinities and NaN among them.
  float any() { return std::bit_cast<float>(static_cast<std::uint32_t>(engine_())); }
  // In [-8, 8), where sums round.
  float near() { return static_cast<float>(static_cast<std::int32_t>(engine_())) * 0x1p-28f; }
  Vec3f vector(bool anything) {
    const auto next = [&] { return anything ? any() : near(); };
    const float x = next(), y = next(), z = next();
    return {x, y, z};
  }

 private:
  std::mt19937 engine_{20240814};
};

// Sixteen vectors: in lanes, and one by one.
struct Lanes {
  Vec3<WideF> wide;
  std::array<Vec3f, 16> lane;
};
Lanes random_lanes(Source& source, bool anything) {
  Lanes out{};
  float x[16], y[16], z[16];
  for (std::size_t i = 0; i < 16; ++i) {
    out.lane[i] = source.vector(anything);
    x[i] = out.lane[i].x, y[i] = out.lane[i].y, z[i] = out.lane[i].z;
  }
  out.wide = {WideF::load(x), WideF::load(y), WideF::load(z)};
  return out;
}
//   expected  std::array<float, 3>(std::size_t lane)
template <class Expected>
bool same_in_lanes(const Vec3<WideF>& wide, Expected&& expected) {
  std::array<float, 16> x{}, y{}, z{};
  for (std::size_t i = 0; i < 16; ++i) {
    const std::array<float, 3> v = expected(i);
    x[i] = v[0], y[i] = v[1], z[i] = v[2];
  }
  return same(wide.x, x) && same(wide.y, y) && same(wide.z, z);
}

Mat4 random_matrix(Source& source) {
  const auto row = [&] { return Vec4f(source.vector(false), source.near()); };
  const Vec4f x = row(), y = row(), z = row();
  return from_rows(x, y, z);
}

}  // namespace

// What compiles in namespace shoal.
namespace shoal {
namespace {
template <class V>
concept HasDot = requires(V v) {
  dot(v, v);
};
template <class A, class B>
concept HasProduct = requires(A a, B b) {
  a* b;
};
template <class M>
concept HasInverse = requires(M m) {
  inverse(m);
};
template <class V>
concept ShrinksImplicitly = std::is_convertible_v<Vec4f, V> || std::is_convertible_v<Vec3d, V>;
}  // namespace
}  // namespace shoal

SHOAL_ISA_CASE(test_operators, "glm: operators of one number round as their expressions") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const bool anything = round % 2 == 0;
    const Vec3f a = source.vector(anything), b = source.vector(anything);
    const float s = anything ? source.any() : source.near();
    REQUIRE(same(a + b, Vec3f{a.x + b.x, a.y + b.y, a.z + b.z}));
    REQUIRE(same(a - b, Vec3f{a.x - b.x, a.y - b.y, a.z - b.z}));
    REQUIRE(same(a * b, Vec3f{a.x * b.x, a.y * b.y, a.z * b.z}));
    REQUIRE(same(a * s, Vec3f{a.x * s, a.y * s, a.z * s}));
    REQUIRE(same(s * a, Vec3f{a.x * s, a.y * s, a.z * s}));
    REQUIRE(same(a / s, Vec3f{a.x / s, a.y / s, a.z / s}));
    REQUIRE(same(-a, Vec3f{-a.x, -a.y, -a.z}));
    const Vec2f p{a.x, a.y}, q{b.x, b.y}, sum = p + q, difference = p - q, product = p * s;
    REQUIRE((same(sum.x, p.x + q.x) && same(sum.y, p.y + q.y)));
    REQUIRE((same(difference.x, p.x - q.x) && same(difference.y, p.y - q.y)));
    REQUIRE((same(product.x, p.x * s) && same(product.y, p.y * s)));
    // In double, for nodes' transforms.
    const Vec3d c{a}, d{b};
    const double t = s;
    REQUIRE(same(c + d, Vec3d{c.x + d.x, c.y + d.y, c.z + d.z}));
    REQUIRE(same(c * t, Vec3d{c.x * t, c.y * t, c.z * t}));
  }
}

SHOAL_ISA_CASE(test_lanes, "glm: operators of sixteen lanes round as their expressions") {
  Source source;
  for (int round = 0; round < kRounds / 16; ++round) {
    const bool anything = round % 2 == 0;
    const Lanes a = random_lanes(source, anything), b = random_lanes(source, anything);
    float factors[16];
    for (float& f : factors) f = anything ? source.any() : source.near();
    const WideF s = WideF::load(factors);
    using V = std::array<float, 3>;
    const auto &p = a.lane, &q = b.lane;
    REQUIRE(same_in_lanes(a.wide + b.wide, [&](std::size_t i) {
      return V{p[i].x + q[i].x, p[i].y + q[i].y, p[i].z + q[i].z};
    }));
    REQUIRE(same_in_lanes(a.wide - b.wide, [&](std::size_t i) {
      return V{p[i].x - q[i].x, p[i].y - q[i].y, p[i].z - q[i].z};
    }));
    REQUIRE(same_in_lanes(a.wide * b.wide, [&](std::size_t i) {
      return V{p[i].x * q[i].x, p[i].y * q[i].y, p[i].z * q[i].z};
    }));
    const auto scaled = [&](std::size_t i) { return V{p[i].x * factors[i], p[i].y * factors[i], p[i].z * factors[i]}; };
    REQUIRE(same_in_lanes(a.wide * s, scaled));
    REQUIRE(same_in_lanes(s * a.wide, scaled));
    REQUIRE(same_in_lanes(a.wide / s, [&](std::size_t i) {
      return V{p[i].x / factors[i], p[i].y / factors[i], p[i].z / factors[i]};
    }));
    REQUIRE(same_in_lanes(-a.wide, [&](std::size_t i) { return V{-p[i].x, -p[i].y, -p[i].z}; }));
    // One template serves both: Shoal's own functions on a lane are the functions on its numbers.
    std::array<float, 16> dots{}, lengths{};
    for (std::size_t i = 0; i < 16; ++i) dots[i] = dot(p[i], q[i]), lengths[i] = length(p[i]);
    REQUIRE(same(dot(a.wide, b.wide), dots));
    REQUIRE(same(length(a.wide), lengths));
    const auto components = [](Vec3f v) { return V{v.x, v.y, v.z}; };
    REQUIRE(same_in_lanes(cross(a.wide, b.wide), [&](std::size_t i) { return components(cross(p[i], q[i])); }));
    REQUIRE(same_in_lanes(normalize(a.wide), [&](std::size_t i) { return components(normalize(p[i])); }));
    REQUIRE(same_in_lanes(lerp(a.wide, b.wide, s),
                          [&](std::size_t i) { return components(lerp(p[i], q[i], factors[i])); }));
    REQUIRE(same_in_lanes(min(a.wide, b.wide), [&](std::size_t i) { return components(min(p[i], q[i])); }));
    REQUIRE(same_in_lanes(max(a.wide, b.wide), [&](std::size_t i) { return components(max(p[i], q[i])); }));
  }
}

SHOAL_ISA_CASE(test_access, "glm: components, columns and conversions are exact") {
  Source source;
  for (int round = 0; round < 200; ++round) {
    const Vec3f a = source.vector(true);
    const float w = source.any();
    const Vec4f v(a, w);
    REQUIRE((same(v[0], a.x) && same(v[1], a.y) && same(v[2], a.z) && same(v[3], w)));
    REQUIRE(same(Vec3f(v), a));
    REQUIRE(same(Vec3d(a), Vec3d{static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)}));
    const Vec3d d{0.1 * static_cast<double>(source.near()), 1.0 / 3, 1e-50};
    REQUIRE(same(Vec3f(d), Vec3f{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)}));
  }
  // Columns, one after the other in memory.
  const Mat4 m = from_rows({1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12});
  const float columns[16] = {1, 5, 9, 0, 2, 6, 10, 0, 3, 7, 11, 0, 4, 8, 12, 1};
  static_assert(sizeof m == sizeof columns);
  CHECK(std::memcmp(&m, columns, sizeof columns) == 0);
  CHECK(m[3].y == 8);
  CHECK(Mat4{Vec4f{1, 5, 9, 0}, Vec4f{2, 6, 10, 0}, Vec4f{3, 7, 11, 0}, Vec4f{4, 8, 12, 1}} == m);
  CHECK(kIdentity4 == from_rows({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}));
  CHECK(sizeof(Affine) == 12 * sizeof(double));
  CHECK(kAffineIdentity == widen(kIdentity4));
  CHECK(narrow(widen(m)) == m);
}

SHOAL_ISA_CASE(test_own_functions, "glm: shoal's matrix functions add in their documented order") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const Mat4 m = random_matrix(source);
    const Vec3f p = source.vector(false);
    const auto component = [&](int r, float offset) {
      return ((m[0][r] * p.x + m[1][r] * p.y) + m[2][r] * p.z) + offset;
    };
    REQUIRE(same(transform_point(m, p), Vec3f{component(0, m[3].x), component(1, m[3].y), component(2, m[3].z)}));
    REQUIRE(same(dot(p, Vec3f(m[0])), (p.x * m[0].x + p.y * m[0].y) + p.z * m[0].z));
  }
}

SHOAL_ISA_CASE(test_forbidden, "glm: its products, inverse and normalize are other functions") {
  Source source;
  int points = 0, dots = 0, inverses = 0, unit_vectors = 0, products = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Mat4 m = random_matrix(source);
    const Vec3f p = source.vector(false);
    const float w = source.near();
    const Vec4f a(p, w), b = m[3];
    points += !same(transform_point(m, p), Vec3f(glm::operator*(m, Vec4f(p, 1.0f))));
    dots += !same(glm::dot(a, b), ((a.x * b.x + a.y * b.y) + a.z * b.z) + a.w * b.w);
    // A vector over its length, which scene/build and scene/procedural use, against GLM's product with a reciprocal.
    unit_vectors += !same(p / std::sqrt(dot(p, p)), glm::normalize(p));
    const glm::dmat4 wide(m);
    Affine inverted{};
    REQUIRE(inverse(widen(m), inverted));
    inverses += !same(inverted[0], Vec3d(glm::inverse(wide)[0]));
    // The offset of a matrix times its inverse cancels: product() makes it zero, GLM's product leaves a residue.
    const Affine none = product(widen(m), inverted);
    const glm::dmat4 residue = wide * glm::inverse(wide);
    products += !same(none[3], Vec3d(residue[3]));
  }
  CHECK(points > 0);
  CHECK(dots > 0);
  CHECK(unit_vectors > 0);
  CHECK(inverses > 0);
  CHECK(products > 0);
  // Of lanes: the same but for the zero vector.
  CHECK(same(normalize(Vec3f{0, 0, 0}), Vec3f{0, 0, 0}));
  CHECK(std::isnan(glm::normalize(Vec3f{0, 0, 0}).x));
}

TEST_CASE(SHOAL_ISA_TEXT ": glm: a call of its functions by shoal's names does not compile") {
  STATIC_REQUIRE(HasDot<Vec3f>);
  STATIC_REQUIRE(HasDot<Vec3<WideF>>);
  STATIC_REQUIRE_FALSE(HasDot<Vec2f>);
  STATIC_REQUIRE_FALSE(HasDot<Vec4f>);
  STATIC_REQUIRE_FALSE(HasProduct<Mat4, Mat4>);
  STATIC_REQUIRE_FALSE(HasProduct<Mat4, Vec4f>);
  STATIC_REQUIRE_FALSE(HasInverse<Mat4>);
  // GLM_FORCE_EXPLICIT_CTOR: digits and components are dropped only where the code says so.
  STATIC_REQUIRE_FALSE(ShrinksImplicitly<Vec3f>);
  STATIC_REQUIRE(std::is_trivially_copyable_v<Vec3f>);
  STATIC_REQUIRE(std::is_trivially_default_constructible_v<Vec3<WideF>>);
  STATIC_REQUIRE(sizeof(Vec3f) == 3 * sizeof(float));
  STATIC_REQUIRE(sizeof(Vec3<WideF>) == 3 * sizeof(WideF));
}
