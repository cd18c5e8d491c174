#include "refraction/narrow/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace shoal {

namespace {

constexpr float kEmptyMin = 3e38f;

struct Box {
  Vec3f lo{kEmptyMin, kEmptyMin, kEmptyMin}, hi{-kEmptyMin, -kEmptyMin, -kEmptyMin};
};
void extend(Box& box, const Box& by) {
  box.lo = {std::min(box.lo.x, by.lo.x), std::min(box.lo.y, by.lo.y), std::min(box.lo.z, by.lo.z)};
  box.hi = {std::max(box.hi.x, by.hi.x), std::max(box.hi.y, by.hi.y), std::max(box.hi.z, by.hi.z)};
}

// Grown by more than the slack of the triangle test (confirm_hit.h) and the rounding of the box test: both are parts of
// the coordinates' size.
Box box_of(const Geometry& geometry, std::int32_t first, std::int32_t count) {
  Box box;
  for (std::int32_t k = first; k < first + count; ++k)
    for (const std::uint32_t v : geometry.triangles[static_cast<std::size_t>(k)].vertex) {
      const Vec3f p = geometry.vertices[v].position_world;
      extend(box, {p, p});
    }
  const auto grow = [](float& lo, float& hi) {
    const float by = (hi - lo) * 2e-5f + std::max(std::fabs(lo), std::fabs(hi)) * 2e-6f;
    lo -= by, hi += by;
  };
  grow(box.lo.x, box.hi.x), grow(box.lo.y, box.hi.y), grow(box.lo.z, box.hi.z);
  return box;
}

void put(TriangleTree::Node& node, int place, const Box& box) {
  node.min_x[place] = box.lo.x, node.min_y[place] = box.lo.y, node.min_z[place] = box.lo.z;
  node.max_x[place] = box.hi.x, node.max_y[place] = box.hi.y, node.max_z[place] = box.hi.z;
}
Box box_of(const TriangleTree::Node& node) {
  Box box;
  for (int i = 0; i < TriangleTree::kWidth; ++i)
    extend(box, {{node.min_x[i], node.min_y[i], node.min_z[i]}, {node.max_x[i], node.max_y[i], node.max_z[i]}});
  return box;
}

TriangleTree::Corners corners_of(const Geometry& geometry, const TriangleTree::Leaf& leaf) {
  TriangleTree::Corners to{};
  for (std::int32_t k = 0; k < leaf.triangle_count; ++k) {
    const Geometry::TriangleRecord& r = geometry.triangles[static_cast<std::size_t>(leaf.first_triangle + k)];
    const Vec3f p0 = geometry.vertices[r.vertex[0]].position_world;
    const Vec3f e1 = geometry.vertices[r.vertex[1]].position_world - p0;
    const Vec3f e2 = geometry.vertices[r.vertex[2]].position_world - p0;
    to.p0_x[k] = p0.x, to.p0_y[k] = p0.y, to.p0_z[k] = p0.z;
    to.e1_x[k] = e1.x, to.e1_y[k] = e1.y, to.e1_z[k] = e1.z;
    to.e2_x[k] = e2.x, to.e2_y[k] = e2.y, to.e2_z[k] = e2.z;
  }
  return to;
}

// A run of triangles and where it is.
struct Place {
  Vec3f middle;
  std::int32_t run;
};
float along(Vec3f v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// Brings a range into an order in which each sixteen, each sixteen sixteens ... are near each other: halves it at the
// median of its longest side, at a whole number of full subtrees.
void arrange(Place* places, std::size_t count) {
  if (count <= TriangleTree::kWidth) return;
  Box box;
  for (std::size_t i = 0; i < count; ++i) extend(box, {places[i].middle, places[i].middle});
  const Vec3f size = box.hi - box.lo;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::size_t subtree = TriangleTree::kWidth;
  while (subtree * TriangleTree::kWidth < count) subtree *= TriangleTree::kWidth;
  const std::size_t half = std::max(subtree, count / 2 / subtree * subtree);
  std::nth_element(places, places + half, places + count, [axis](const Place& a, const Place& b) {
    const float at_a = along(a.middle, axis), at_b = along(b.middle, axis);
    return at_a != at_b ? at_a < at_b : a.run < b.run;
  });
  arrange(places, half);
  arrange(places + half, count - half);
}

}  // namespace

void TriangleTree::build(const Geometry& geometry, const Materials& materials, bool with_corners) {
  struct Run {
    std::int32_t first, count;
    bool one_sided, masked;
  };
  std::vector<Run> runs;
  std::vector<Place> places;
  for (const Chunk& chunk : geometry.chunks) {
    const Material& material = materials.materials[chunk.material];
    if (material.alpha_mode == AlphaMode::kBlend) continue;
    for (int k = 0; k < chunk.triangle_count; k += kWidth) {
      runs.push_back({static_cast<std::int32_t>(chunk.first_triangle) + k, std::min(kWidth, chunk.triangle_count - k),
                      !material.double_sided, material.alpha_mode == AlphaMode::kMask});
      const Box box = box_of(geometry, runs.back().first, runs.back().count);
      places.push_back({(box.lo + box.hi) * 0.5f, static_cast<std::int32_t>(runs.size() - 1)});
    }
  }
  arrange(places.data(), places.size());
  leaves.clear();
  for (const Place& place : places) {
    const Run& run = runs[static_cast<std::size_t>(place.run)];
    leaves.push() = {run.first, run.count, run.one_sided, run.masked};
  }

  corners.resize(with_corners ? leaves.size() : 0);

  // Sixteen at a time, level by level, up to one root.
  nodes.clear();
  std::vector<std::int32_t> level;
  for (std::size_t i = 0; i < leaves.size(); ++i) level.push_back(~static_cast<std::int32_t>(i));
  while (level.size() > 1 || (level.size() == 1 && level[0] < 0)) {
    std::vector<std::int32_t> above;
    for (std::size_t i = 0; i < level.size(); i += kWidth) {
      Node& node = nodes.push();
      for (int k = 0; k < kWidth; ++k) {
        put(node, k, Box());
        const std::size_t child = i + static_cast<std::size_t>(k);
        node.child[k] = child < level.size() ? level[child] : kNone;
      }
      above.push_back(static_cast<std::int32_t>(nodes.size() - 1));
    }
    level = above;
  }
  refit(geometry);
}

void TriangleTree::refit(const Geometry& geometry) {
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = corners_of(geometry, leaves[i]);
  // Children come before their parents. Empty places keep their inverted boxes.
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Node& node = nodes[n];
    for (int k = 0; k < kWidth; ++k) {
      const std::int32_t child = node.child[k];
      if (child < 0) {
        const Leaf& leaf = leaves[static_cast<std::size_t>(~child)];
        put(node, k, box_of(geometry, leaf.first_triangle, leaf.triangle_count));
      } else if (child != kNone) {
        put(node, k, box_of(nodes[static_cast<std::size_t>(child)]));
      }
    }
  }
}

}  // namespace shoal
