#include "trace/bvh16.h"

#include <algorithm>
#include <bit>
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

// Grown by more than the slack of the triangle test (raster/triangle_test.h) and the rounding of the box test: both are
// parts of the coordinates' size.
Box grown(Box box) {
  const auto grow = [](float& lo, float& hi) {
    const float by =
        (hi - lo) * Bvh16::kGrowthOfSize + std::max(std::fabs(lo), std::fabs(hi)) * Bvh16::kGrowthOfCoordinates;
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
Box box_of(const Geometry& geometry, const Bvh16::Leaf& leaf) {
  Box box;
  for (const std::int32_t id : leaf.id)
    if (id != Bvh16::kNone) extend(box, box_of(geometry, id));
  return grown(box);
}

void put(Bvh16::Boxes& boxes, int place, const Box& box) {
  boxes.lo[0][place] = box.lo.x, boxes.lo[1][place] = box.lo.y, boxes.lo[2][place] = box.lo.z;
  boxes.hi[0][place] = box.hi.x, boxes.hi[1][place] = box.hi.y, boxes.hi[2][place] = box.hi.z;
}
Box box_of(const Bvh16::Boxes& boxes) {
  Box box;
  for (int i = 0; i < Bvh16::kWidth; ++i)
    extend(box, {{boxes.lo[0][i], boxes.lo[1][i], boxes.lo[2][i]}, {boxes.hi[0][i], boxes.hi[1][i], boxes.hi[2][i]}});
  return box;
}

// Calls body(i) for each i below count, many at a time.
template <class Body>
void for_ranges(ThreadPool& pool, std::size_t count, Body body) {
  constexpr std::size_t kAtATime = 1024;
  pool.for_each((count + kAtATime - 1) / kAtATime, [&](std::size_t range, int) {
    for (std::size_t i = range * kAtATime; i < std::min(count, (range + 1) * kAtATime); ++i) body(i);
  });
}

// Three floats and one that does not count, in one register: most of the time goes into taking bounds.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
constexpr Float4 float4(float v) { return Float4{v, v, v, v}; }

struct Bounds {
  Float4 lo = float4(kEmptyMin), hi = float4(-kEmptyMin);
  void add(Float4 from, Float4 to) { lo = from < lo ? from : lo, hi = to > hi ? to : hi; }
  // Half its surface.
  float area() const {
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x < 0.0f ? 0.0f : x * y + y * z + z * x;
  }
};

// A triangle and its box; its id is in the place that does not count.
struct Primitive {
  Float4 lo, hi;
  std::int32_t triangle() const { return std::bit_cast<std::int32_t>(float{hi[3]}); }
};

struct Range {
  std::size_t first, count;
};
// Halves of a range of primitives, or a leaf.
struct Split {
  Range primitives;
  float area = 0;
  std::int32_t left = -1, right = -1;  // splits; -1: a leaf
  int leaves = 1;
};

// Splits primitives by the surface area heuristic, down to leaves: each range where the halves' areas times their
// counts are least, of sixteen places along each axis. Source: Goldsmith and Salmon 1987; Wald 2007 (bins).
class Builder {
 public:
  // Ranges of at most max_task_size are not split: they become `tasks`, and leaves of `splits`.
  Builder(std::vector<Primitive>& of, Range range, int level, std::size_t max_task_size)
      : primitives(of), task_size(max_task_size) {
    split(range, level);
  }

  struct Task {
    std::int32_t split;
    int level;
  };
  std::vector<Split> splits;  // the root first, halves after what they are halves of
  std::vector<Task> tasks;

 private:
  static constexpr int kBins = 16;

  std::int32_t split(Range range, int level) {
    const std::int32_t at = static_cast<std::int32_t>(splits.size());
    Bounds bounds, middles;
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
      const Primitive& primitive = primitives[i];
      bounds.add(primitive.lo, primitive.hi);
      const Float4 middle = primitive.lo + primitive.hi;
      middles.add(middle, middle);
    }
    splits.push_back({range, bounds.area()});
    if (range.count <= Bvh16::kWidth) return at;
    if (range.count <= task_size) {
      tasks.push_back({at, level});
      return at;
    }
    // However they lie, there are no more than kMaxLevels: halves of 2^31 are leaves after 27.
    const std::size_t half = level < Bvh16::kMaxLevels - 28 ? divide(range, middles) : range.count / 2;
    const std::int32_t left = split({range.first, half}, level + 1);
    const std::int32_t right = split({range.first + half, range.count - half}, level + 1);
    splits[static_cast<std::size_t>(at)].left = left, splits[static_cast<std::size_t>(at)].right = right;
    return at;
  }

  // Brings a range into two parts, neither empty; returns how many are in the first.
  //   middles  twice the middles' bounds
  std::size_t divide(Range range, const Bounds& middles) {
    Float4 per = float4(0.0f);
    for (int a = 0; a < 3; ++a) {
      const float bins = static_cast<float>(kBins) / (middles.hi[a] - middles.lo[a]);
      if (std::isfinite(bins)) per[a] = bins;
    }
    const auto bins_of = [&](const Primitive& primitive) {
      const Float4 at = (primitive.lo + primitive.hi - middles.lo) * per, last = float4(kBins - 1);
      return __builtin_convertvector(at < last ? at : last, Int4);
    };
    Bounds bounds[3][kBins];
    std::size_t counts[3][kBins] = {};
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
      const Int4 bin = bins_of(primitives[i]);
      for (int a = 0; a < 3; ++a) bounds[a][bin[a]].add(primitives[i].lo, primitives[i].hi), ++counts[a][bin[a]];
    }

    float best = kEmptyMin;
    int best_axis = -1, best_bin = 0;
    for (int a = 0; a < 3; ++a) {
      float cost_after[kBins];
      std::size_t count_after[kBins];
      const auto add_up = [&](int bin, Bounds& sum, std::size_t& count) {
        sum.add(bounds[a][bin].lo, bounds[a][bin].hi), count += counts[a][bin];
        return sum.area() * static_cast<float>(count);
      };
      Bounds after, before;
      std::size_t so_far = 0;
      for (int k = kBins - 1; k > 0; --k) cost_after[k] = add_up(k, after, so_far), count_after[k] = so_far;
      so_far = 0;
      for (int k = 1; k < kBins; ++k) {
        const float cost = add_up(k - 1, before, so_far) + cost_after[k];
        if (so_far != 0 && count_after[k] != 0 && cost < best) best = cost, best_axis = a, best_bin = k;
      }
    }
    if (best_axis < 0) return range.count / 2;
    const auto from = primitives.begin() + static_cast<std::ptrdiff_t>(range.first);
    const auto middle =
        std::partition(from, from + static_cast<std::ptrdiff_t>(range.count),
                       [&](const Primitive& primitive) { return bins_of(primitive)[best_axis] < best_bin; });
    return static_cast<std::size_t>(middle - from);
  }

  std::vector<Primitive>& primitives;
  std::size_t task_size;
};

// The same tree for any number of threads.
std::vector<Split> split_all(std::vector<Primitive>& primitives, ThreadPool& pool) {
  Builder top(primitives, {0, primitives.size()}, 0, std::max(primitives.size() / 64, std::size_t{4096}));
  std::vector<std::vector<Split>> parts(top.tasks.size());
  pool.for_each(parts.size(), [&](std::size_t i, int) {
    const Builder::Task& task = top.tasks[i];
    Builder part(primitives, top.splits[static_cast<std::size_t>(task.split)].primitives, task.level, 0);
    parts[i] = std::move(part.splits);
  });
  std::vector<Split> all = std::move(top.splits);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    // A part's root takes its place in the top; the others come behind.
    const std::int32_t moved = static_cast<std::int32_t>(all.size()) - 1;
    for (Split& split : parts[i])
      if (split.left >= 0) split.left += moved, split.right += moved;
    all[static_cast<std::size_t>(top.tasks[i].split)] = parts[i][0];
    all.insert(all.end(), parts[i].begin() + 1, parts[i].end());
  }
  // Halves come after what they are halves of.
  for (std::size_t i = all.size(); i-- > 0;)
    if (all[i].left >= 0)
      all[i].leaves =
          all[static_cast<std::size_t>(all[i].left)].leaves + all[static_cast<std::size_t>(all[i].right)].leaves;
  return all;
}

// Boxes of the triangles of one content.
std::vector<Primitive> primitives_of(const Geometry& geometry, const Materials& materials, Bvh16::Content content,
                                     ThreadPool& pool) {
  const bool blended = content == Bvh16::Content::kBlended;
  std::vector<std::int32_t> triangles;
  for (const Meshlet& meshlet : geometry.meshlets)
    if ((materials.materials[meshlet.material].alpha_mode == AlphaMode::kBlend) == blended)
      for (int k = 0; k < meshlet.triangle_count; ++k)
        triangles.push_back(static_cast<std::int32_t>(meshlet.first_triangle) + k);
  std::vector<Primitive> primitives(triangles.size());
  for_ranges(pool, primitives.size(), [&](std::size_t i) {
    const Box box = box_of(geometry, triangles[i]);
    const Vec3f lo = box.lo, hi = box.hi;
    primitives[i] =
        Primitive{Float4{lo.x, lo.y, lo.z, 0.0f}, Float4{hi.x, hi.y, hi.z, std::bit_cast<float>(triangles[i])}};
  });
  return primitives;
}

// Sixteen parts of a split: the largest are opened, first those of more leaves than a node has places, then those that
// fit in whole.
int open_split(const std::vector<Split>& splits, std::int32_t (&parts)[Bvh16::kWidth]) {
  int count = 1;
  const auto open_largest = [&](auto may) {
    int largest = -1;
    float area = -1;
    for (int i = 0; i < count; ++i) {
      const Split& split = splits[static_cast<std::size_t>(parts[i])];
      if (split.left >= 0 && may(split) && split.area > area) area = split.area, largest = i;
    }
    if (largest < 0) return false;
    const Split& split = splits[static_cast<std::size_t>(parts[largest])];
    parts[count++] = split.right, parts[largest] = split.left;
    return true;
  };
  constexpr int kWidth = Bvh16::kWidth;
  while (count < kWidth && open_largest([](const Split& split) { return split.leaves > kWidth; })) continue;
  while (count < kWidth && open_largest([&](const Split& split) { return count + split.leaves - 1 <= kWidth; }))
    continue;
  return count;
}

}  // namespace

void Bvh16::build(const Geometry& geometry, const Materials& materials, Content content, bool with_corners,
                  ThreadPool& pool) {
  nodes.clear(), leaves.clear(), kinds.clear(), corners.clear();
  std::vector<Primitive> primitives = primitives_of(geometry, materials, content, pool);
  if (primitives.empty()) return;
  const std::vector<Split> splits = split_all(primitives, pool);
  leaves.reserve(static_cast<std::size_t>(splits[0].leaves)), kinds.reserve(static_cast<std::size_t>(splits[0].leaves));
  const auto make_leaf = [&](Range of) {
    Leaf& leaf = leaves.push();
    Kinds kind{};
    for (std::size_t k = 0; k < kWidth; ++k) {
      leaf.id[k] = k < of.count ? primitives[of.first + k].triangle() : kNone;
      if (k >= of.count) continue;
      const std::uint16_t bit = static_cast<std::uint16_t>(1u << k);
      const Material& material = materials.materials[geometry.triangles[static_cast<std::size_t>(leaf.id[k])].material];
      kind.present |= bit;
      if (!material.double_sided) kind.one_sided |= bit;
      if (material.alpha_mode == AlphaMode::kMask) kind.alpha_tested |= bit;
      if (!material.unlit && content == Content::kOpaque) kind.casts_shadow |= bit;
    }
    kinds.push() = kind;
    return ~static_cast<std::int32_t>(leaves.size() - 1);
  };
  // Children are made before their parents.
  const auto make_node = [&](const auto& self, std::int32_t of) -> std::int32_t {
    std::int32_t parts[kWidth] = {of}, child[kWidth];
    const int count = open_split(splits, parts);
    for (int i = 0; i < kWidth; ++i) {
      child[i] = kNone;
      if (i >= count) continue;
      const Split& split = splits[static_cast<std::size_t>(parts[i])];
      child[i] = split.left < 0 ? make_leaf(split.primitives) : self(self, parts[i]);
    }
    Node& node = nodes.push();
    for (int i = 0; i < kWidth; ++i) put(node.boxes, i, Box()), node.child[i] = child[i];
    return static_cast<std::int32_t>(nodes.size() - 1);
  };
  make_node(make_node, 0);
  corners.resize(with_corners ? leaves.size() : 0);
  refit(geometry, pool);
}

void Bvh16::refit(const Geometry& geometry, ThreadPool& pool) {
  std::vector<Box> leaf_box(leaves.size());
  for_ranges(pool, leaves.size(), [&](std::size_t i) {
    if (corners.size() != 0) find_corners(geometry.triangles.data(), geometry.vertices.data(), leaves[i], corners[i]);
    leaf_box[i] = box_of(geometry, leaves[i]);
  });
  // Children come before their parents. Empty places keep their inverted boxes.
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Node& node = nodes[n];
    for (int k = 0; k < kWidth; ++k) {
      const std::int32_t child = node.child[k];
      if (child < 0)
        put(node.boxes, k, leaf_box[static_cast<std::size_t>(~child)]);
      else if (child != kNone)
        put(node.boxes, k, box_of(nodes[static_cast<std::size_t>(child)].boxes));
    }
  }
}

}  // namespace shoal
