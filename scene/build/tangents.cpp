#include "scene/build/tangents.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/math.h"

namespace shoal {
namespace {

Vec3d to_double(Vec3f v) { return {v.x, v.y, v.z}; }

// The unit vector of v, or zero where its squared length is at most 1e-60.
Vec3d unit(Vec3d v) {
  const double length2 = dot(v, v);
  return length2 > 1e-60 ? v * (1.0 / std::sqrt(length2)) : Vec3d{0, 0, 0};
}
bool is_zero(Vec3d v) { return v.x == 0 && v.y == 0 && v.z == 0; }

Vec3d any_across(Vec3d n) {
  const Vec3d axis = std::fabs(n.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  return unit(axis - n * dot(axis, n));
}

// Assigns each vertex the number of its group of equal position, normal and texture coordinates; -0 equals 0.
std::vector<std::uint32_t> weld(const MeshPrimitive& mesh, const std::vector<Vec2f>& uvs, std::size_t& count) {
  struct Key {
    float value[8];
    std::uint32_t vertex;
  };
  std::vector<Key> keys(mesh.positions.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Vec3f p = mesh.positions[i], n = mesh.normals[i];
    keys[i] = {{p.x, p.y, p.z, n.x, n.y, n.z, uvs[i].x, uvs[i].y}, static_cast<std::uint32_t>(i)};
    for (float& v : keys[i].value) v = v + 0.0f;
  }
  const auto order = [](const Key& a, const Key& b) { return std::memcmp(a.value, b.value, sizeof a.value); };
  std::sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
    const int less = order(a, b);
    return less != 0 ? less < 0 : a.vertex < b.vertex;
  });
  std::vector<std::uint32_t> group(keys.size());
  count = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i > 0 && order(keys[i - 1], keys[i]) != 0) ++count;
    group[keys[i].vertex] = static_cast<std::uint32_t>(count);
  }
  if (!keys.empty()) ++count;
  return group;
}

// The direction of increasing u on a triangle, and its side: 0 right-handed (w 1), 1 left-handed (w -1), 2 no area.
struct FaceTangent {
  Vec3d direction;
  int side = 2;
};
FaceTangent face_tangent(const MeshPrimitive& mesh, const std::vector<Vec2f>& uvs, const std::uint32_t* corner) {
  const Vec3d p = to_double(mesh.positions[corner[0]]);
  const Vec3d e1 = to_double(mesh.positions[corner[1]]) - p, e2 = to_double(mesh.positions[corner[2]]) - p;
  const Vec2f a = uvs[corner[0]], b = uvs[corner[1]], c = uvs[corner[2]];
  const double u1 = double{b.x} - a.x, v1 = double{b.y} - a.y, u2 = double{c.x} - a.x, v2 = double{c.y} - a.y;
  const double area = u1 * v2 - u2 * v1;
  FaceTangent face{{0, 0, 0}, 2};
  if (!(std::fabs(area) > 1e-37)) return face;
  face.side = area < 0 ? 0 : 1;
  face.direction = unit((e1 * v2 - e2 * v1) * (area < 0 ? -1.0 : 1.0));
  return face;
}

// The angle of a triangle at a corner, in the vertex's tangent plane.
double angle_at(Vec3d here, Vec3d before, Vec3d after, Vec3d n) {
  const auto on_plane = [n](Vec3d v) { return unit(v - n * dot(v, n)); };
  const double cosine = dot(on_plane(before - here), on_plane(after - here));
  return static_cast<double>(det_acos(static_cast<float>(std::min(std::max(cosine, -1.0), 1.0))));
}

template <class T>
void append_copies(std::vector<T>& values, const std::vector<std::uint32_t>& sources, std::size_t width = 1) {
  if (values.empty()) return;
  for (const std::uint32_t s : sources) {
    for (std::size_t k = 0; k < width; ++k) {
      const T value = values[s * width + k];
      values.push_back(value);
    }
  }
}

void append_vertices(MeshPrimitive& mesh, const std::vector<std::uint32_t>& sources) {
  append_copies(mesh.positions, sources);
  append_copies(mesh.normals, sources);
  append_copies(mesh.uvs, sources);
  append_copies(mesh.uvs1, sources);
  append_copies(mesh.colors, sources);
  append_copies(mesh.joints, sources, mesh.influences);
  append_copies(mesh.weights, sources, mesh.influences);
  for (MorphTarget& target : mesh.targets) {
    append_copies(target.positions, sources);
    append_copies(target.normals, sources);
  }
}

}  // namespace

Vec4f place_tangent(const Mat4& t, Vec4f tangent) {
  const auto row = [&](int r) { return Vec3d{t[0][r], t[1][r], t[2][r]}; };
  const Vec3d d{tangent.x, tangent.y, tangent.z};
  Vec3d world = unit({dot(row(0), d), dot(row(1), d), dot(row(2), d)});
  if (is_zero(world)) world = {1, 0, 0};
  const bool mirrored = dot(row(0), cross(row(1), row(2))) < 0;
  return {static_cast<float>(world.x), static_cast<float>(world.y), static_cast<float>(world.z),
          mirrored ? -tangent.w : tangent.w};
}

void generate_tangents(MeshPrimitive& mesh, const std::vector<Vec2f>& uvs) {
  const std::size_t vertices = mesh.positions.size();
  std::size_t group_count = 0;
  const std::vector<std::uint32_t> group = weld(mesh, uvs, group_count);

  // Sum the tangents by group and side, in the order of the triangles.
  std::vector<Vec3d> sum(2 * group_count, Vec3d{0, 0, 0});
  std::vector<char> has(2 * group_count, 0);
  std::vector<int> sides(mesh.indices.size() / 3);
  for (std::size_t t = 0; t < sides.size(); ++t) {
    const std::uint32_t* corner = &mesh.indices[3 * t];
    const FaceTangent face = face_tangent(mesh, uvs, corner);
    sides[t] = face.side;
    if (face.side == 2) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = corner[k];
      const Vec3d n = to_double(mesh.normals[v]);
      const Vec3d across = unit(face.direction - n * dot(face.direction, n));
      const double angle = angle_at(to_double(mesh.positions[v]), to_double(mesh.positions[corner[(k + 2) % 3]]),
                                    to_double(mesh.positions[corner[(k + 1) % 3]]), n);
      const std::size_t at = 2 * std::size_t{group[v]} + static_cast<std::size_t>(face.side);
      sum[at] = sum[at] + across * angle;
      has[at] = 1;
    }
  }

  // The first side that uses a vertex keeps it; the second receives a copy.
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  std::vector<std::uint32_t> place(2 * vertices, kNone), copies;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t v = mesh.indices[i];
    const std::size_t first = 2 * std::size_t{group[v]};
    const int face_side = sides[i / 3];
    const std::size_t side = face_side != 2                  ? static_cast<std::size_t>(face_side)
                             : !has[first] && has[first + 1] ? 1u
                                                             : 0u;
    std::uint32_t& to = place[2 * std::size_t{v} + side];
    if (to == kNone) {
      if (place[2 * std::size_t{v} + 1 - side] == kNone) {
        to = v;
      } else {
        to = static_cast<std::uint32_t>(vertices + copies.size());
        copies.push_back(v);
      }
    }
    mesh.indices[i] = to;
  }
  append_vertices(mesh, copies);

  mesh.tangents.assign(vertices + copies.size(), Vec4f{0, 0, 0, 0});
  for (std::size_t v = 0; v < vertices; ++v) {
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t to = place[2 * v + side];
      if (to == kNone && !(side == 0 && place[2 * v + 1] == kNone)) continue;
      Vec3d t = unit(sum[2 * std::size_t{group[v]} + side]);
      if (is_zero(t)) t = any_across(to_double(mesh.normals[v]));
      mesh.tangents[to == kNone ? v : to] = {static_cast<float>(t.x), static_cast<float>(t.y), static_cast<float>(t.z),
                                             side == 0 ? 1.0f : -1.0f};
    }
  }
}

}  // namespace shoal
