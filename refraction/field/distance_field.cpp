#include "refraction/field/distance_field.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "refraction/field/point_triangle.h"

namespace shoal {

namespace {

constexpr float kOverlap_m = 0.02f;  // what reaches this little over the plane counts as beyond it
constexpr float kBandVoxels = 1.5f;  // about each triangle, where distances are exact
constexpr float kUnset = 3e38f;
constexpr std::int32_t kNone = -1;
constexpr std::int32_t kRows = 16;  // of a sweep's plane, for one task

struct Box {
  Vec3f lo, hi;
};

struct PlacedTriangle {
  Vec3f corner[3];
  Box bounds;
  std::int32_t id;
};

float least(float a, float b, float c) { return std::min(std::min(a, b), c); }
float greatest(float a, float b, float c) { return std::max(std::max(a, b), c); }

PlacedTriangle place(const RenderScene& scene, const WaterBody& body, std::uint32_t id) {
  PlacedTriangle t;
  t.id = static_cast<std::int32_t>(id);
  const Geometry& g = scene.geometry;
  for (int k = 0; k < 3; ++k) t.corner[k] = to_plane(body, g.vertices[g.triangles[id].vertex[k]].position_world);
  const Vec3f &a = t.corner[0], &b = t.corner[1], &c = t.corner[2];
  t.bounds = {{least(a.x, b.x, c.x), least(a.y, b.y, c.y), least(a.z, b.z, c.z)},
              {greatest(a.x, b.x, c.x), greatest(a.y, b.y, c.y), greatest(a.z, b.z, c.z)}};
  return t;
}

Box outline_bounds(const WaterBody& body) {
  Box box{{kUnset, 0, kUnset}, {-kUnset, 0, -kUnset}};
  for (const Vec3f& corner : body.outline) {
    const Vec3f p = to_plane(body, corner);
    box.lo.x = std::min(box.lo.x, p.x), box.lo.z = std::min(box.lo.z, p.z);
    box.hi.x = std::max(box.hi.x, p.x), box.hi.z = std::max(box.hi.z, p.z);
  }
  return box;
}

// The triangles on the body's far side, and the box that holds them (below: their part under the outline).
std::vector<PlacedTriangle> find_triangles(const RenderScene& scene, const WaterBody& body, bool below, Box& box) {
  const Box outline = outline_bounds(body);
  box = outline;
  std::vector<PlacedTriangle> found;
  for (const Drawable& d : scene.geometry.drawables) {
    if (!d.drawn || scene.materials.materials[d.material].alpha_mode == AlphaMode::kBlend) continue;
    for (std::uint32_t i = 0; i < d.triangle_count; ++i) {
      const PlacedTriangle t = place(scene, body, d.first_triangle + i);
      const Box& b = t.bounds;
      if (below ? b.lo.y > kOverlap_m : b.hi.y < -kOverlap_m) continue;
      if (below) {
        if (b.hi.x < outline.lo.x || b.lo.x > outline.hi.x || b.hi.z < outline.lo.z || b.lo.z > outline.hi.z) continue;
        box.lo.y = std::min(box.lo.y, b.lo.y);
      } else {
        box.lo.x = std::min(box.lo.x, b.lo.x), box.lo.z = std::min(box.lo.z, b.lo.z);
        box.hi = {std::max(box.hi.x, b.hi.x), std::max(box.hi.y, b.hi.y), std::max(box.hi.z, b.hi.z)};
      }
      found.push_back(t);
    }
  }
  return found;
}

// Voxels whose centres are from lo to hi, along one axis.
struct Range {
  std::int32_t first, last;
};
Range voxel_range(float lo, float hi, float min_m, float voxel_m, std::int32_t count) {
  const auto index = [&](float at) {
    const float voxels = (at - min_m) / voxel_m - 0.5f;
    return std::min(std::max(voxels, -1.0f), static_cast<float>(count));
  };
  return {std::max(static_cast<std::int32_t>(std::ceil(index(lo))), 0),
          std::min(static_cast<std::int32_t>(std::floor(index(hi))), count - 1)};
}

// Builds one field. While it does, `nearest` holds places in `triangles`.
class FieldBuilder {
 public:
  FieldBuilder(DistanceField& field, const std::vector<PlacedTriangle>& triangles, ThreadPool& pool)
      : f_(field), triangles_(triangles), pool_(pool) {
    const std::size_t voxels = static_cast<std::size_t>(f_.count_x) * static_cast<std::size_t>(f_.count_y) *
                               static_cast<std::size_t>(f_.count_z);
    f_.distance_m.assign(voxels, kUnset);
    f_.nearest.assign(voxels, kNone);
  }

  // Exact distances near triangles, a slice of voxels at a time. A voxel's triangle is the nearest, of equally near
  // ones the first, in whatever order they come.
  void band() {
    const float reach = kBandVoxels * f_.voxel_m;
    std::vector<std::vector<std::int32_t>> of_slice(static_cast<std::size_t>(f_.count_z));
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Box& b = triangles_[i].bounds;
      const Range z = voxel_range(b.lo.z - reach, b.hi.z + reach, f_.min_m.z, f_.voxel_m, f_.count_z);
      for (std::int32_t k = z.first; k <= z.last; ++k)
        of_slice[static_cast<std::size_t>(k)].push_back(static_cast<std::int32_t>(i));
    }
    pool_.for_each(of_slice.size(), [&](std::size_t slice, int) {
      const std::int32_t z = static_cast<std::int32_t>(slice);
      for (const std::int32_t i : of_slice[slice]) {
        const Box& b = triangles_[static_cast<std::size_t>(i)].bounds;
        const Range x = voxel_range(b.lo.x - reach, b.hi.x + reach, f_.min_m.x, f_.voxel_m, f_.count_x);
        const Range y = voxel_range(b.lo.y - reach, b.hi.y + reach, f_.min_m.y, f_.voxel_m, f_.count_y);
        for (std::int32_t j = y.first; j <= y.last; ++j)
          for (std::int32_t h = x.first; h <= x.last; ++h) {
            const float d = distance(h, j, z, i);
            if (d <= reach) offer(h, j, z, i, d);
          }
      }
    });
  }

  // Hands triangles on along an axis, plane of voxels by plane: a voxel takes the best of the nine nearest of the last plane.
  //   axis  0 to 2; step 1 or -1
  void sweep(int axis, std::int32_t step) {
    const std::int32_t count[3] = {f_.count_x, f_.count_y, f_.count_z};
    const int across = axis == 0 ? 1 : 0, down = axis == 2 ? 1 : 2;  // the plane's own axes
    for (std::int32_t k = 1; k < count[axis]; ++k) {
      const std::int32_t at = step > 0 ? k : count[axis] - 1 - k;
      pool_.for_each(static_cast<std::size_t>((count[down] + kRows - 1) / kRows), [&](std::size_t rows, int) {
        std::int32_t v[3];
        v[axis] = at, v[down] = static_cast<std::int32_t>(rows) * kRows;
        const std::int32_t end = std::min(v[down] + kRows, count[down]);
        for (; v[down] < end; ++v[down])
          for (v[across] = 0; v[across] < count[across]; ++v[across]) look_back(v, axis, step, across, down, count);
      });
    }
  }

  void finish() {
    for (std::int32_t& nearest : f_.nearest)
      nearest = nearest == kNone ? kNone : triangles_[static_cast<std::size_t>(nearest)].id;
  }

 private:
  std::size_t slot(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(f_.count_y) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(f_.count_x) +
           static_cast<std::size_t>(x);
  }
  float distance(std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t triangle) const {
    const Vec3f p{f_.min_m.x + (static_cast<float>(x) + 0.5f) * f_.voxel_m,
                  f_.min_m.y + (static_cast<float>(y) + 0.5f) * f_.voxel_m,
                  f_.min_m.z + (static_cast<float>(z) + 0.5f) * f_.voxel_m};
    const PlacedTriangle& t = triangles_[static_cast<std::size_t>(triangle)];
    return std::sqrt(triangle_distance2(p, t.corner[0], t.corner[1], t.corner[2]));
  }
  void offer(std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t triangle, float distance_m) {
    const std::size_t at = slot(x, y, z);
    if (distance_m > f_.distance_m[at] || (distance_m == f_.distance_m[at] && triangle >= f_.nearest[at])) return;
    f_.distance_m[at] = distance_m;
    f_.nearest[at] = triangle;
  }
  void look_back(const std::int32_t (&v)[3], int axis, std::int32_t step, int across, int down,
                 const std::int32_t (&count)[3]) {
    for (std::int32_t j = -1; j <= 1; ++j)
      for (std::int32_t i = -1; i <= 1; ++i) {
        std::int32_t from[3] = {v[0], v[1], v[2]};
        from[axis] -= step, from[across] += i, from[down] += j;
        if (from[across] < 0 || from[across] >= count[across] || from[down] < 0 || from[down] >= count[down]) continue;
        take_from(v, from, i == 0 && j == 0 ? 1.0f : i == 0 || j == 0 ? 1.4142136f : 1.7320508f);
      }
  }
  void take_from(const std::int32_t (&to)[3], const std::int32_t (&from)[3], float apart_voxels) {
    const std::size_t there = slot(from[0], from[1], from[2]), here = slot(to[0], to[1], to[2]);
    const std::int32_t triangle = f_.nearest[there];
    if (triangle == kNone || triangle == f_.nearest[here]) return;
    // No nearer than this, by the triangle inequality.
    if (f_.distance_m[there] - apart_voxels * f_.voxel_m > f_.distance_m[here]) return;
    offer(to[0], to[1], to[2], triangle, distance(to[0], to[1], to[2], triangle));
  }

  DistanceField& f_;
  const std::vector<PlacedTriangle>& triangles_;
  ThreadPool& pool_;
};

}  // namespace

std::size_t DistanceFields::bytes() const {
  std::size_t sum = 0;
  for (const auto* fields : {&below, &above})
    for (const DistanceField& field : *fields) sum += field.bytes();
  return sum;
}

void DistanceFields::build(const RenderScene& scene, const Camera* camera, int resolution, ThreadPool& pool) {
  const auto begin = std::chrono::steady_clock::now();
  below.resize(scene.waters.size()), above.resize(scene.waters.size());
  for (std::size_t b = 0; b < scene.waters.size(); ++b) {
    const WaterBody& body = scene.waters[b];
    const bool both = camera == nullptr || camera->orthographic;
    const bool eye_above = !both && to_plane(body, camera->position_world).y >= 0;
    if (both || eye_above) below[b] = build_distance_field(scene, body, true, resolution, pool);
    if (both || !eye_above) above[b] = build_distance_field(scene, body, false, resolution, pool);
  }
  build_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

Vec3f to_plane(const WaterBody& body, Vec3f p_world) {
  const Vec3f p = p_world - body.origin;
  return {dot(p, body.axis_x), dot(p, body.normal), dot(p, body.axis_z)};
}

DistanceField build_distance_field(const RenderScene& scene, const WaterBody& body, bool below, int resolution,
                                   ThreadPool& pool) {
  DistanceField field;
  Box box;
  const std::vector<PlacedTriangle> triangles = find_triangles(scene, body, below, box);
  if (triangles.empty()) return field;
  // A voxel of air all round, so that no surface lies in the box's sides.
  const Vec3f size = box.hi - box.lo;
  field.voxel_m = std::max(greatest(size.x, size.y, size.z), 1e-3f) / static_cast<float>(resolution);
  const auto count = [&](float length) { return static_cast<std::int32_t>(std::ceil(length / field.voxel_m)) + 2; };
  field.count_x = count(size.x), field.count_y = count(size.y), field.count_z = count(size.z);
  field.min_m = box.lo - Vec3f{field.voxel_m, field.voxel_m, field.voxel_m};

  FieldBuilder builder(field, triangles, pool);
  builder.band();
  for (const int axis : {0, 1, 2})
    for (const std::int32_t step : {1, -1}) builder.sweep(axis, step);
  builder.finish();
  return field;
}

}  // namespace shoal
