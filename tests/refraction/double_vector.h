// Vectors in double for oracles: three components of GLM's type, and operations written here, none of the renderer's.
#pragma once

#include <cmath>

#include "core/vec.h"

namespace shoal_test {

using namespace shoal;

inline Vec3d as_double(Vec3f v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
inline Vec3f as_float(Vec3d v) {
  return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm_of(Vec3d v) { return std::sqrt(dot(v, v)); }
inline Vec3d unit_of(Vec3d v) { return v / norm_of(v); }

}  // namespace shoal_test
