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
Box grown(Box box) {
  const auto grow = [](float& lo, float& hi) {
    const float by = (hi - lo) * 2e-5f + std::max(std::fabs(lo), std::fabs(hi)) * 2e-6f;
    lo -= by, hi += by;
  };
  grow(box.lo.x, box.hi.x), grow(box.lo.y, box.hi.y), grow(box.lo.z, box.hi.z);
  return box;
}
Box box_of(const Geometry& geometry, std::int32_t triangle) {
  Box box;
  for (const std::uint32_t v : geometry.triangles[static_cast<std::size_t>(triangle)].vertex) {
    const Vec3f p = geometry.vertices[v].position_world;
    extend(box, {p, p});
  }
  return box;
}
Box box_of(const Geometry& geometry, const TriangleTree::Leaf& leaf) {
  Box box;
  for (const std::int32_t id : leaf.id)
    if (id != TriangleTree::kNone) extend(box, box_of(geometry, id));
  return grown(box);
}

void put(TriangleTree::Boxes& boxes, int place, const Box& box) {
  boxes.lo[0][place] = box.lo.x, boxes.lo[1][place] = box.lo.y, boxes.lo[2][place] = box.lo.z;
  boxes.hi[0][place] = box.hi.x, boxes.hi[1][place] = box.hi.y, boxes.hi[2][place] = box.hi.z;
}
Box box_of(const TriangleTree::Boxes& boxes) {
  Box box;
  for (int i = 0; i < TriangleTree::kWidth; ++i)
    extend(box, {{boxes.lo[0][i], boxes.lo[1][i], boxes.lo[2][i]}, {boxes.hi[0][i], boxes.hi[1][i], boxes.hi[2][i]}});
  return box;
}

void find_corners(const Geometry& geometry, TriangleTree::Leaf& leaf) {
  for (int k = 0; k < TriangleTree::kWidth; ++k) {
    const auto put = [k](float (*to)[TriangleTree::kWidth], Vec3f v) { to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z; };
    Vec3f p0{0, 0, 0}, e1 = p0, e2 = p0;
    if (leaf.id[k] != TriangleTree::kNone) {
      const Geometry::TriangleRecord& r = geometry.triangles[static_cast<std::size_t>(leaf.id[k])];
      p0 = geometry.vertices[r.vertex[0]].position_world;
      e1 = geometry.vertices[r.vertex[1]].position_world - p0;
      e2 = geometry.vertices[r.vertex[2]].position_world - p0;
    }
    put(leaf.p0, p0), put(leaf.e1, e1), put(leaf.e2, e2);
  }
}

// A triangle and its box.
struct Item {
  float lo[3], hi[3];
  std::int32_t triangle;
  float middle2(int axis) const { return lo[axis] + hi[axis]; }
};
struct Bounds {
  float lo[3] = {kEmptyMin, kEmptyMin, kEmptyMin}, hi[3] = {-kEmptyMin, -kEmptyMin, -kEmptyMin};
  void add(const float* from, const float* to) {
    for (int a = 0; a < 3; ++a) lo[a] = std::min(lo[a], from[a]), hi[a] = std::max(hi[a], to[a]);
  }
  // Half its surface.
  float area() const {
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x < 0.0f ? 0.0f : x * y + y * z + z * x;
  }
};

// Halves of a range of items, or a leaf.
struct Split {
  Bounds bounds;
  std::int32_t left = -1, right = -1;  // splits; -1: a leaf
  std::uint32_t first = 0, count = 0;  // items
  int leaves = 1;
};

class Builder {
 public:
  explicit Builder(std::vector<Item>& of) : items(of) {
    splits.reserve(items.size() / 4 + 1);
    split(0, static_cast<std::uint32_t>(items.size()));
  }
  std::vector<Item>& items;
  std::vector<Split> splits;  // the root first

 private:
  static constexpr int kBins = 16;
  // Where binned items of an axis go.
  struct Binning {
    float from = 0, per = 0;
    int operator()(float at) const { return std::clamp(static_cast<int>((at - from) * per), 0, kBins - 1); }
  };

  std::int32_t split(std::uint32_t first, std::uint32_t count) {
    const std::int32_t at = static_cast<std::int32_t>(splits.size());
    Split& made = splits.emplace_back();
    made.first = first, made.count = count;
    Bounds middles;
    for (std::uint32_t i = first; i < first + count; ++i) {
      const Item& item = items[i];
      made.bounds.add(item.lo, item.hi);
      const float m[3] = {item.middle2(0), item.middle2(1), item.middle2(2)};
      middles.add(m, m);
    }
    if (count <= TriangleTree::kWidth) return at;
    const std::uint32_t half = divide(first, count, middles);
    const std::int32_t left = split(first, half);
    const std::int32_t right = split(first + half, count - half);
    Split& whole = splits[static_cast<std::size_t>(at)];
    whole.left = left, whole.right = right;
    whole.leaves = splits[static_cast<std::size_t>(left)].leaves + splits[static_cast<std::size_t>(right)].leaves;
    return at;
  }

  // Brings a range into two parts; returns how many are in the first.
  std::uint32_t divide(std::uint32_t first, std::uint32_t count, const Bounds& middles) {
    float best = kEmptyMin;
    int best_axis = -1, best_bin = 0;
    Binning binning[3];
    for (int a = 0; a < 3; ++a) {
      const float size = middles.hi[a] - middles.lo[a];
      binning[a] = {middles.lo[a], size > 0.0f ? static_cast<float>(kBins) / size : 0.0f};
      if (!(size > 0.0f) || !std::isfinite(binning[a].per)) continue;
      Bounds bounds[kBins];
      std::uint32_t counts[kBins] = {};
      for (std::uint32_t i = first; i < first + count; ++i) {
        const int bin = binning[a](items[i].middle2(a));
        bounds[bin].add(items[i].lo, items[i].hi), ++counts[bin];
      }
      float area_after[kBins] = {};
      std::uint32_t count_after[kBins] = {};
      Bounds after;
      std::uint32_t so_far = 0;
      for (int k = kBins - 1; k > 0; --k) {
        after.add(bounds[k].lo, bounds[k].hi), so_far += counts[k];
        area_after[k] = after.area(), count_after[k] = so_far;
      }
      Bounds before;
      so_far = 0;
      for (int k = 1; k < kBins; ++k) {
        before.add(bounds[k - 1].lo, bounds[k - 1].hi), so_far += counts[k - 1];
        if (so_far == 0 || count_after[k] == 0) continue;
        const float cost = before.area() * static_cast<float>(so_far) + area_after[k] * static_cast<float>(count_after[k]);
        if (cost < best) best = cost, best_axis = a, best_bin = k;
      }
    }
    if (best_axis < 0) return count / 2;
    const auto middle = std::partition(items.begin() + first, items.begin() + first + count, [&](const Item& item) {
      return binning[best_axis](item.middle2(best_axis)) < best_bin;
    });
    return static_cast<std::uint32_t>(middle - items.begin()) - first;
  }
};

}  // namespace

void TriangleTree::build(const Geometry& geometry, const Materials& materials) {
  std::vector<Item> items;
  for (const Chunk& chunk : geometry.chunks) {
    if (materials.materials[chunk.material].alpha_mode == AlphaMode::kBlend) continue;
    for (int k = 0; k < chunk.triangle_count; ++k) {
      const std::int32_t triangle = static_cast<std::int32_t>(chunk.first_triangle) + k;
      const Box box = box_of(geometry, triangle);
      items.push_back({{box.lo.x, box.lo.y, box.lo.z}, {box.hi.x, box.hi.y, box.hi.z}, triangle});
    }
  }
  nodes.clear(), leaves.clear(), kinds.clear();
  if (items.empty()) return;
  const Builder built(items);
  const auto make_leaf = [&](const Split& split) {
    Leaf& leaf = leaves.push();
    Kinds& kind = kinds.push();
    kind = {};
    for (std::uint32_t k = 0; k < kWidth; ++k) {
      leaf.id[k] = kNone;
      if (k >= split.count) continue;
      leaf.id[k] = items[split.first + k].triangle;
      const std::uint16_t bit = static_cast<std::uint16_t>(1u << k);
      const Material& material = materials.materials[geometry.triangles[static_cast<std::size_t>(leaf.id[k])].material];
      kind.there |= bit;
      if (!material.double_sided) kind.one_sided |= bit;
      if (material.alpha_mode == AlphaMode::kMask) kind.masked |= bit;
    }
    return ~static_cast<std::int32_t>(leaves.size() - 1);
  };
  // Sixteen parts of a split: its largest is opened again and again. Children are made before their parents.
  const auto make_node = [&](const auto& self, std::int32_t of) -> std::int32_t {
    std::int32_t parts[kWidth] = {of};
    int count = 1;
    const auto open_largest = [&](auto may) {
      int largest = -1;
      float area = -1;
      for (int i = 0; i < count; ++i) {
        const Split& split = built.splits[static_cast<std::size_t>(parts[i])];
        if (split.left >= 0 && may(split) && split.bounds.area() > area) area = split.bounds.area(), largest = i;
      }
      if (largest < 0) return false;
      const Split& split = built.splits[static_cast<std::size_t>(parts[largest])];
      parts[count++] = split.right, parts[largest] = split.left;
      return true;
    };
    while (count < kWidth && open_largest([](const Split& split) { return split.leaves > kWidth; })) continue;
    while (count < kWidth && open_largest([&](const Split& split) { return count + split.leaves - 1 <= kWidth; })) continue;
    std::int32_t child[kWidth];
    for (int i = 0; i < kWidth; ++i) {
      child[i] = kNone;
      if (i >= count) continue;
      const Split& split = built.splits[static_cast<std::size_t>(parts[i])];
      child[i] = split.left < 0 ? make_leaf(split) : self(self, parts[i]);
    }
    Node& node = nodes.push();
    for (int i = 0; i < kWidth; ++i) put(node.boxes, i, Box()), node.child[i] = child[i];
    return static_cast<std::int32_t>(nodes.size() - 1);
  };
  make_node(make_node, 0);
  refit(geometry);
}

void TriangleTree::refit(const Geometry& geometry) {
  for (std::size_t i = 0; i < leaves.size(); ++i) find_corners(geometry, leaves[i]);
  // Children come before their parents. Empty places keep their inverted boxes.
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Node& node = nodes[n];
    for (int k = 0; k < kWidth; ++k) {
      const std::int32_t child = node.child[k];
      if (child < 0)
        put(node.boxes, k, box_of(geometry, leaves[static_cast<std::size_t>(~child)]));
      else if (child != kNone)
        put(node.boxes, k, box_of(nodes[static_cast<std::size_t>(child)].boxes));
    }
  }
}

}  // namespace shoal
