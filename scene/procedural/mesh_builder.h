// Parametric meshes for procedural scenes: every shape consists of surfaces P(u, v) over the unit square.
//
// A part is a function of a PartBuilder and a level of detail. A builder without a mesh only counts triangles, so that
// a scene is fitted to a triangle count before it is built. All arithmetic is + - * / sqrt and core/math.h: the meshes
// are the same bytes on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math.h"
#include "core/vec.h"
#include "scene/scene.h"

namespace shoal {

struct SurfacePoint {
  Vec3f position;
  Vec3f normal;  // unit; ignored where Normals::kSmooth is used
  Vec2f uv;
  Vec3f color{1, 1, 1};
};

// The edges of a surface that shrink to a point: a quad there is one triangle.
enum class Poles { kOpen, kV0, kV1, kBoth };

// kGiven: the function gives the normals. kSmooth: they are computed from differences of the function's positions.
enum class Normals { kGiven, kSmooth };

inline float clamp01(float x) { return std::min(1.0f, std::max(0.0f, x)); }
// Linear interpolation, exact at both ends, so that neighbouring surfaces meet.
inline float mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }
inline Vec3f mix(Vec3f a, Vec3f b, float t) { return a * (1.0f - t) + b * t; }
inline float smooth_step(float lo, float hi, float x) {
  const float t = clamp01((x - lo) / (hi - lo));
  return t * t * (3.0f - 2.0f * t);
}
inline float length(Vec3f v) { return std::sqrt(dot(v, v)); }
inline Vec3f normalize(Vec3f v) {
  const float l = length(v);
  return l > 0 ? v / l : Vec3f{0, 1, 0};
}

// Cosine and sine of a share of a full turn. A whole turn equals none exactly, so that seams close.
inline Vec2f turn(float share) {
  const float angle = (share - std::floor(share)) * 6.2831853f;
  return {det_cos(angle), det_sin(angle)};
}

class PartBuilder {
 public:
  //   mesh  receives the surfaces; null: the builder only counts triangles
  explicit PartBuilder(Mesh* mesh) : mesh_(mesh) {}
  bool counting() const { return mesh_ == nullptr; }
  std::uint64_t triangles() const { return triangles_; }

  // Adds P(u, v), u and v in [0, 1], as nu x nv quads. The front is the side of dP/du x dP/dv. Quads are ordered in
  // blocks of 7 x 7, which have 64 vertices.
  //   at  SurfacePoint(float u, float v)
  template <class Fn>
  void surface(int material, int nu, int nv, Fn&& at, Normals normals = Normals::kGiven, Poles poles = Poles::kOpen) {
    const bool pole0 = poles == Poles::kV0 || poles == Poles::kBoth;
    const bool pole1 = poles == Poles::kV1 || poles == Poles::kBoth;
    const auto u64 = [](int n) { return static_cast<std::uint64_t>(n); };
    triangles_ += 2 * u64(nu) * u64(nv) - (pole0 ? u64(nu) : 0) - (pole1 ? u64(nu) : 0);
    if (counting()) return;
    MeshPrimitive& p = primitive(material);
    const auto first = static_cast<std::uint32_t>(p.positions.size());
    reserve(p, static_cast<std::size_t>(nu) + 1, static_cast<std::size_t>(nv) + 1);
    for (int j = 0; j <= nv; ++j) {
      for (int i = 0; i <= nu; ++i) {
        const float u = static_cast<float>(i) / static_cast<float>(nu),
                    v = static_cast<float>(j) / static_cast<float>(nv);
        SurfacePoint s = at(u, v);
        if (normals == Normals::kSmooth) s.normal = smooth_normal(at, u, v);
        push(p, s);
      }
    }
    constexpr int kBlock = 7;
    for (int j0 = 0; j0 < nv; j0 += kBlock) {
      for (int i0 = 0; i0 < nu; i0 += kBlock) {
        for (int j = j0; j < std::min(nv, j0 + kBlock); ++j) {
          for (int i = i0; i < std::min(nu, i0 + kBlock); ++i) {
            const auto row = static_cast<std::uint32_t>(nu + 1);
            const std::uint32_t a = first + static_cast<std::uint32_t>(j) * row + static_cast<std::uint32_t>(i);
            const std::uint32_t b = a + 1, c = b + row, d = a + row;
            if (!(pole0 && j == 0)) p.indices.insert(p.indices.end(), {a, b, c});
            if (!(pole1 && j == nv - 1)) {
              p.indices.insert(p.indices.end(), {a, c, d});
            }
          }
        }
      }
    }
  }

  // Adds a flat parallelogram: corner + u * along_u + v * along_v; texture coordinates are metres divided by
  // `uv_metres`.
  void quad(int material, int nu, int nv, Vec3f corner, Vec3f along_u, Vec3f along_v, float uv_metres,
            Vec3f color = {1, 1, 1}) {
    const Vec3f n = normalize(cross(along_u, along_v));
    const float su = length(along_u) / uv_metres, sv = length(along_v) / uv_metres;
    surface(material, nu, nv, [&](float u, float v) {
      return SurfacePoint{corner + along_u * u + along_v * v, n, {u * su, (1.0f - v) * sv}, color};
    });
  }

  // Adds an axis-aligned box with outward faces of n x n quads.
  void box(int material, int n, Vec3f lo, Vec3f hi, float uv_metres, Vec3f color = {1, 1, 1}) {
    const Vec3f d = hi - lo, x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
    quad(material, n, n, lo + z, x, y, uv_metres, color);
    quad(material, n, n, lo + x, -x, y, uv_metres, color);
    quad(material, n, n, lo + x + z, -z, y, uv_metres, color);
    quad(material, n, n, lo, z, y, uv_metres, color);
    quad(material, n, n, lo + y + z, x, -z, uv_metres, color);
    quad(material, n, n, lo, x, z, uv_metres, color);
  }

  // Adds a solid of revolution about the vertical through `base`.
  //   profile  Vec2f(float t): (radius, height) from bottom to top
  //   poles    the ends that lie on the axis
  template <class Fn>
  void lathe(int material, int around, int up, Vec3f base, Fn&& profile, Poles poles, Vec2f uv_scale,
             Vec3f color = {1, 1, 1}) {
    surface(
        material, around, up,
        [&](float u, float v) {
          const Vec2f c = turn(1.0f - u), p = profile(v);
          return SurfacePoint{
              base + Vec3f{c.x * p.x, p.y, c.y * p.x}, {0, 1, 0}, {u * uv_scale.x, (1.0f - v) * uv_scale.y}, color};
        },
        Normals::kSmooth, poles);
  }

  // Adds a tube along a path. Flat caps close its ends unless the path is a loop.
  //   path  Vec3f(float t)
  //   side  a direction that is never parallel to the path
  template <class Fn>
  void tube(int material, int around, int along, float radius, Fn&& path, Vec3f side, bool loop, Vec2f uv_scale,
            Vec3f color = {1, 1, 1}) {
    const auto ring = [&](float t, float u, Vec3f& centre, Vec3f& out, Vec3f& tangent) {
      const float h = 1.0f / 512.0f, t0 = loop ? t - h : std::max(0.0f, t - h),
                  t1 = loop ? t + h : std::min(1.0f, t + h);
      centre = path(t);
      tangent = normalize(path(t1) - path(t0));
      const Vec3f x = normalize(cross(tangent, side)), y = cross(tangent, x);
      const Vec2f c = turn(u);
      out = x * c.x + y * c.y;
    };
    surface(material, around, along, [&](float u, float v) {
      Vec3f centre, out, tangent;
      ring(v, u, centre, out, tangent);
      return SurfacePoint{centre + out * radius, out, {u * uv_scale.x, v * uv_scale.y}, color};
    });
    if (loop) return;
    for (const float end : {0.0f, 1.0f}) {
      surface(
          material, around, 1,
          [&](float u, float v) {
            Vec3f centre, out, tangent;
            ring(end, u, centre, out, tangent);
            // The cap of the start shrinks towards v = 0, that of the end towards v = 1, so that both face outward.
            const float r = end == 0.0f ? v : 1.0f - v;
            return SurfacePoint{centre + out * (radius * r), end == 0.0f ? -tangent : tangent, {u, v}, color};
          },
          Normals::kGiven, end == 0.0f ? Poles::kV0 : Poles::kV1);
    }
  }

 private:
  static void push(MeshPrimitive& p, const SurfacePoint& s) {
    p.positions.push_back(s.position);
    p.normals.push_back(s.normal);
    p.uvs.push_back(s.uv);
    p.colors.push_back({s.color.x, s.color.y, s.color.z, 1.0f});
  }

  // Reserves the exact size for a surface that is most of its mesh, so that large scenes hold no unused memory.
  static void reserve(MeshPrimitive& p, std::size_t nu, std::size_t nv) {
    if (nu * nv < p.positions.size()) return;
    const std::size_t vertices = p.positions.size() + nu * nv;
    p.positions.reserve(vertices);
    p.normals.reserve(vertices);
    p.uvs.reserve(vertices);
    p.colors.reserve(vertices);
    p.indices.reserve(p.indices.size() + 6 * nu * nv);
  }

  // Returns the primitive of a material, which its first use adds.
  MeshPrimitive& primitive(int material) {
    for (MeshPrimitive& p : mesh_->primitives) {
      if (p.material == material) return p;
    }
    mesh_->primitives.emplace_back();
    mesh_->primitives.back().material = material;
    return mesh_->primitives.back();
  }

  // The normal from central differences, one-sided at the square's edges in v. At a pole, where dP/du vanishes, it is
  // taken beside it.
  template <class Fn>
  static Vec3f smooth_normal(Fn&& at, float u, float v) {
    constexpr float kStep = 1.0f / 1024.0f;
    for (const float beside : {0.0f, 4.0f * kStep}) {
      const float w = v < 0.5f ? v + beside : v - beside;
      const float v0 = std::max(0.0f, w - kStep), v1 = std::min(1.0f, w + kStep);
      const Vec3f du = at(u + kStep, w).position - at(u - kStep, w).position;
      const Vec3f dv = at(u, v1).position - at(u, v0).position;
      const Vec3f n = cross(du, dv);
      if (dot(n, n) > 1e-6f * dot(du, du) * dot(dv, dv) && dot(du, du) > 1e-6f * dot(dv, dv)) return normalize(n);
    }
    return {0, 1, 0};
  }

  Mesh* mesh_;
  std::uint64_t triangles_ = 0;
};

}  // namespace shoal
