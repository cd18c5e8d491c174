#include "scene/procedural/part_plan.h"

#include <algorithm>
#include <string>

namespace shoal {
namespace {

std::uint64_t count(PartFn add, int level) {
  PartBuilder b(nullptr);
  add(b, level);
  return b.triangles();
}

// Returns the finest level of at most `budget` triangles; 1 where there is none.
int finest_level(PartFn add, std::uint64_t budget) {
  int lo = 1, hi = 2;
  while (hi < (1 << 26) && count(add, hi) <= budget) {
    lo = hi;
    hi *= 2;
  }
  while (hi - lo > 1) {
    const int mid = lo + (hi - lo) / 2;
    (count(add, mid) <= budget ? lo : hi) = mid;
  }
  return lo;
}

struct Plan {
  std::vector<int> levels;  // one a part; 0: the part is left out
  int filler = 1;
};

Plan make_plan(const std::vector<Part>& parts, const Part& filler, std::uint64_t triangles) {
  Plan plan;
  plan.levels.resize(parts.size());
  std::uint64_t left = triangles - std::min(triangles, count(filler.add, 1));
  double shares = filler.share;
  std::uint64_t spent_at_least = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const std::uint64_t cost = count(part.add, 1) * part.places.size();
    // A part is included where the parts so far need at most half of the triangles, so that half remain to refine them.
    if (!part.always && 2 * (spent_at_least + cost) > left) continue;
    spent_at_least += cost;
    plan.levels[i] = 1;
    shares += part.share;
  }
  // Each part receives its share of the remaining triangles and leaves what it cannot use. The coarsest levels of later
  // parts stay reserved.
  std::uint64_t aside = spent_at_least;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (plan.levels[i] == 0) continue;
    const Part& part = parts[i];
    const std::uint64_t copies = part.places.size();
    aside -= count(part.add, 1) * copies;
    const std::uint64_t free = left > aside ? left - aside : 0;
    const auto share = static_cast<std::uint64_t>(static_cast<double>(left) * (part.share / shares));
    plan.levels[i] = finest_level(part.add, std::min(share, free) / copies);
    left -= std::min(left, count(part.add, plan.levels[i]) * copies);
    shares -= part.share;
  }
  plan.filler = finest_level(filler.add, left + count(filler.add, 1));
  return plan;
}

std::int32_t add_mesh(Scene& scene, const Part& part, int level) {
  Mesh mesh;
  mesh.name = part.name;
  PartBuilder builder(&mesh);
  part.add(builder, level);
  scene.meshes.push_back(std::move(mesh));
  return static_cast<std::int32_t>(scene.meshes.size()) - 1;
}

void add_node(Scene& scene, std::string name, std::int32_t parent, std::int32_t mesh, const Mat4& place) {
  Node node;
  node.name = std::move(name);
  node.parent = parent;
  node.mesh = mesh;
  node.world_from_local = place;
  scene.nodes.push_back(std::move(node));
}

void add_part(Scene& scene, const Part& part, int level) {
  const std::int32_t mesh = add_mesh(scene, part, level);
  if (part.places.size() == 1) {
    add_node(scene, part.name, kNoIndex, mesh, part.places[0]);
    return;
  }
  const std::string name = part.name;
  const auto group = static_cast<std::int32_t>(scene.nodes.size());
  add_node(scene, part.plural ? part.plural : name + "s", kNoIndex, kNoIndex, kIdentity4);
  for (std::size_t k = 0; k < part.places.size(); ++k) {
    add_node(scene, name + "_" + std::to_string(k + 1), group, mesh, part.places[k]);
  }
}

}  // namespace

std::vector<Mat4> places_at(std::initializer_list<Vec3f> at) {
  std::vector<Mat4> places;
  for (const Vec3f& p : at) places.push_back(translation(p));
  return places;
}

void add_parts(Scene& scene, const std::vector<Part>& parts, const Part& filler, std::uint64_t triangles) {
  const Plan plan = make_plan(parts, filler, std::max<std::uint64_t>(triangles, 1));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (plan.levels[i] != 0) add_part(scene, parts[i], plan.levels[i]);
  }
  add_part(scene, filler, plan.filler);
}

}  // namespace shoal
