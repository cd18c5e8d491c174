// An oracle for poses, morph targets and skins in double with the standard library's functions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/scene.h"

namespace shoal::test {

using Matrix = std::array<std::array<double, 4>, 4>;
using Quaternion = std::array<double, 4>;  // x y z w

inline Matrix identity() { return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}; }
inline Matrix multiply(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t k = 0; k < 4; ++k) out[r][c] += a[r][k] * b[k][c];
  return out;
}
inline Matrix as_double(const Mat4& m) {
  Matrix out{};
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) out[std::size_t(r)][std::size_t(c)] = static_cast<double>(m[c][r]);
  return out;
}
inline Vec3d point(const Matrix& m, Vec3d p) {
  const auto row = [&](std::size_t r) { return m[r][0] * p.x + m[r][1] * p.y + m[r][2] * p.z + m[r][3]; };
  return {row(0), row(1), row(2)};
}
inline Vec3d as_double(Vec3f v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

inline Quaternion unit(Quaternion q) {
  const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& v : q) v /= n;
  return q;
}
// Rotates a vector by q v q*, written out as two cross products.
inline Vec3d turn(const Quaternion& q, Vec3d v) {
  const Vec3d u{q[0], q[1], q[2]};
  const Vec3d t = cross(u, v) * 2.0;
  return v + t * q[3] + cross(u, t);
}
inline Matrix from_parts(const glm::dvec3& t, const Quaternion& rotation, const glm::dvec3& s) {
  Matrix out = identity();
  const Quaternion q = unit(rotation);
  const Vec3d axes[3] = {turn(q, {1, 0, 0}), turn(q, {0, 1, 0}), turn(q, {0, 0, 1})};
  const double scales[3] = {s.x, s.y, s.z}, offsets[3] = {t.x, t.y, t.z};
  for (std::size_t c = 0; c < 3; ++c) {
    out[0][c] = axes[c].x * scales[c];
    out[1][c] = axes[c].y * scales[c];
    out[2][c] = axes[c].z * scales[c];
    out[c][3] = offsets[c];
  }
  return out;
}

// By the specification's appendix C: acos and sin of the whole angle.
inline Quaternion spherical(Quaternion a, Quaternion b, double t) {
  a = unit(a);
  b = unit(b);
  double d = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const double sign = d < 0 ? -1 : 1;
  d = std::min(std::fabs(d), 1.0);
  const double angle = std::acos(d);
  Quaternion out{};
  for (std::size_t i = 0; i < 4; ++i) {
    out[i] = angle < 1e-9 ? (1 - t) * a[i] + t * sign * b[i]
                          : std::sin((1 - t) * angle) / std::sin(angle) * a[i] +
                                sign * std::sin(t * angle) / std::sin(angle) * b[i];
  }
  return unit(out);
}

inline std::vector<double> value_at(const Channel& c, double time) {
  const bool cubic = c.interpolation == Interpolation::kCubicSpline;
  const std::size_t keys = c.times_s.size(), width = c.values.size() / keys / (cubic ? 3 : 1);
  const auto at = [&](std::size_t key, std::size_t part, std::size_t i) {
    return static_cast<double>(c.values[((cubic ? 3 * key + part : key)) * width + i]);
  };
  std::vector<double> out(width);
  std::size_t k = 0;
  while (k + 1 < keys && static_cast<double>(c.times_s[k + 1]) <= time) ++k;
  const double t0 = static_cast<double>(c.times_s[k]);
  const bool ends = k + 1 == keys || time <= t0;
  const double span = ends ? 1 : static_cast<double>(c.times_s[k + 1]) - t0, t = ends ? 0 : (time - t0) / span;
  for (std::size_t i = 0; i < width; ++i) {
    const double v0 = at(k, 1, i);
    if (ends || c.interpolation == Interpolation::kStep) {
      out[i] = v0;
    } else if (cubic) {
      const double v1 = at(k + 1, 1, i), b0 = at(k, 2, i), a1 = at(k + 1, 0, i);
      out[i] = (2 * t * t * t - 3 * t * t + 1) * v0 + span * (t * t * t - 2 * t * t + t) * b0 +
               (-2 * t * t * t + 3 * t * t) * v1 + span * (t * t * t - t * t) * a1;
    } else {
      out[i] = v0 + (at(k + 1, 1, i) - v0) * t;
    }
  }
  if (c.path != ChannelPath::kRotation) return out;
  Quaternion q{out[0], out[1], out[2], out[3]};
  if (!ends && c.interpolation == Interpolation::kLinear) {
    q = spherical({at(k, 1, 0), at(k, 1, 1), at(k, 1, 2), at(k, 1, 3)},
                  {at(k + 1, 1, 0), at(k + 1, 1, 1), at(k + 1, 1, 2), at(k + 1, 1, 3)}, t);
  }
  q = unit(q);
  return {q[0], q[1], q[2], q[3]};
}

// The scene under the channels of some animations.
struct OraclePose {
  std::vector<Matrix> world;
  std::vector<std::vector<double>> weights;
};
inline OraclePose oracle_pose(const Scene& scene, const std::vector<std::size_t>& animations, double time) {
  OraclePose pose;
  std::vector<LocalTransform> locals = scene.locals;
  for (const Node& node : scene.nodes) pose.weights.emplace_back(node.morph_weights.begin(), node.morph_weights.end());
  for (const std::size_t a : animations) {
    for (const Channel& c : scene.animations[a].channels) {
      const std::vector<double> v = value_at(c, time);
      LocalTransform& local = locals[static_cast<std::size_t>(c.node)];
      if (c.path == ChannelPath::kWeights) pose.weights[static_cast<std::size_t>(c.node)] = v;
      if (c.path == ChannelPath::kTranslation) local.translation = {v[0], v[1], v[2]};
      if (c.path == ChannelPath::kRotation) local.rotation = {v[0], v[1], v[2], v[3]};
      if (c.path == ChannelPath::kScale) local.scale = {v[0], v[1], v[2]};
    }
  }
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    Matrix local = identity();
    if (locals.empty()) {
      pose.world.push_back(as_double(scene.nodes[n].world_from_local));
      continue;
    }
    const LocalTransform& l = locals[n];
    if (l.is_matrix) {
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) local[std::size_t(r)][std::size_t(c)] = l.matrix[c][r];
    } else {
      local = from_parts(l.translation, {l.rotation.x, l.rotation.y, l.rotation.z, l.rotation.w}, l.scale);
    }
    const std::int32_t parent = scene.nodes[n].parent;
    pose.world.push_back(parent == kNoIndex ? local : multiply(pose.world[static_cast<std::size_t>(parent)], local));
  }
  return pose;
}

// A vertex of a primitive in the world: each joint moves the point, the results are averaged.
inline Vec3d oracle_position(const Scene& scene, const OraclePose& pose, std::size_t n, const MeshPrimitive& mesh,
                             std::size_t v) {
  Vec3d p = as_double(mesh.positions[v]);
  for (std::size_t t = 0; t < mesh.targets.size(); ++t) {
    if (!mesh.targets[t].positions.empty()) p = p + as_double(mesh.targets[t].positions[v]) * pose.weights[n][t];
  }
  const std::int32_t skin_index = scene.nodes[n].skin;
  if (skin_index == kNoIndex || mesh.influences == 0) return point(pose.world[n], p);
  const Skin& skin = scene.skins[static_cast<std::size_t>(skin_index)];
  Vec3d sum{0, 0, 0};
  for (std::size_t k = v * mesh.influences; k < (v + 1) * mesh.influences; ++k) {
    const std::size_t j = mesh.joints[k];
    const Matrix& joint = pose.world[static_cast<std::size_t>(skin.joints[j])];
    sum = sum + point(joint, point(as_double(skin.joint_from_mesh[j]), p)) * static_cast<double>(mesh.weights[k]);
  }
  return sum;
}

// The greatest distance of a triangle's corner from where it should be, over the scene's extent.
inline double worst_position(const Scene& scene, const RenderScene& render, const OraclePose& pose) {
  double worst = 0;
  double extent = 0;
  for (const Drawable& d : render.geometry.drawables) {
    const MeshPrimitive& mesh =
        scene.meshes[static_cast<std::size_t>(scene.nodes[d.node].mesh)].primitives[d.primitive];
    for (std::size_t t = 0; t < d.triangle_count; ++t) {
      const Geometry::TriangleRecord& triangle = render.geometry.triangles[d.first_triangle + t];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d want = oracle_position(scene, pose, d.node, mesh, mesh.indices[3 * t + k]);
        extent = std::max({extent, std::fabs(want.x), std::fabs(want.y), std::fabs(want.z)});
        double nearest = 1e300;  // the winding may be turned
        for (const std::uint32_t corner : triangle.vertex) {
          const Vec3d off = as_double(render.geometry.vertices[corner].position_world) - want;
          nearest = std::min(nearest, std::sqrt(dot(off, off)));
        }
        worst = std::max(worst, nearest);
      }
    }
  }
  return worst / extent;
}

}  // namespace shoal::test
