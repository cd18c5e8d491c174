// Measurements for tests of built-in scenes: triangle counts, valid meshes, closed solids, digests.
#pragma once

#include <catch2/catch.hpp>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace shoal::test {

inline Scene make(const std::string& name, std::uint64_t triangles) {
  for (const ProceduralScene& s : procedural_scenes()) {
    if (name == s.name) return s.make(triangles);
  }
  throw std::runtime_error("no such scene: " + name);
}

inline std::uint64_t count_triangles(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh == kNoIndex) continue;
    for (const MeshPrimitive& p : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives)
      count += p.indices.size() / 3;
  }
  return count;
}

inline const Mesh* find_mesh(const Scene& scene, const std::string& name) {
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.name == name) return &mesh;
  }
  return nullptr;
}

inline bool unit(float x) { return x >= 0 && x <= 1; }

inline void check_sound(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    INFO(scene.name << ": " << mesh.name);
    std::size_t bad_vertices = 0, degenerate = 0, against_normal = 0, bad_indices = 0;
    for (const MeshPrimitive& p : mesh.primitives) {
      REQUIRE(p.normals.size() == p.positions.size());
      REQUIRE(p.uvs.size() == p.positions.size());
      REQUIRE(p.colors.size() == p.positions.size());
      REQUIRE(p.indices.size() % 3 == 0);
      REQUIRE(static_cast<std::size_t>(p.material) < scene.materials.materials.size());
      for (std::size_t i = 0; i < p.positions.size(); ++i) {
        const Vec3f v = p.positions[i], n = p.normals[i];
        const bool finite = std::isfinite(v.x + v.y + v.z) && std::isfinite(p.uvs[i].x + p.uvs[i].y);
        const bool colour = unit(p.colors[i].x) && unit(p.colors[i].y) && unit(p.colors[i].z) && p.colors[i].w == 1;
        if (!finite || !colour || std::fabs(dot(n, n) - 1.0f) > 1e-5f) ++bad_vertices;
      }
      for (std::size_t i = 0; i < p.indices.size(); i += 3) {
        const std::uint32_t ia = p.indices[i], ib = p.indices[i + 1], ic = p.indices[i + 2];
        if (std::max({ia, ib, ic}) >= p.positions.size()) {
          ++bad_indices;
          continue;
        }
        const Vec3f a = p.positions[ia], b = p.positions[ib], c = p.positions[ic], face = cross(b - a, c - a);
        if (dot(face, face) == 0) ++degenerate;
        // The front is the side that the normals are on.
        if (dot(face, p.normals[ia] + p.normals[ib] + p.normals[ic]) < 0) ++against_normal;
      }
    }
    CHECK(bad_vertices == 0);
    CHECK(bad_indices == 0);
    CHECK(degenerate == 0);
    CHECK(against_normal == 0);
  }
}

// Every edge, by the positions of its ends, runs as often one way as the other: closed, and wound one way round.
inline bool is_closed(const Mesh& mesh) {
  using Key = std::array<float, 6>;
  std::map<Key, int> edges;
  for (const MeshPrimitive& p : mesh.primitives) {
    for (std::size_t i = 0; i < p.indices.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        // + 0: minus zero is zero
        const Vec3f a = p.positions[p.indices[i + k]], b = p.positions[p.indices[i + (k + 1) % 3]];
        const Key forth{a.x + 0, a.y + 0, a.z + 0, b.x + 0, b.y + 0, b.z + 0},
            back{b.x + 0, b.y + 0, b.z + 0, a.x + 0, a.y + 0, a.z + 0};
        if (forth < back)
          ++edges[forth];
        else
          --edges[back];
      }
    }
  }
  return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

inline double signed_volume(const Mesh& mesh) {
  double volume = 0;
  for (const MeshPrimitive& p : mesh.primitives) {
    for (std::size_t i = 0; i < p.indices.size(); i += 3) {
      const Vec3f a = p.positions[p.indices[i]], b = p.positions[p.indices[i + 1]], c = p.positions[p.indices[i + 2]];
      volume += (double(a.x) * (double(b.y) * c.z - double(b.z) * c.y) +
                 double(a.y) * (double(b.z) * c.x - double(b.x) * c.z) +
                 double(a.z) * (double(b.x) * c.y - double(b.y) * c.x)) /
                6.0;
    }
  }
  return volume;
}

template <class T>
void update(XXH3_state_t* state, const std::vector<T>& data) {
  const std::uint64_t size = data.size();
  XXH3_64bits_update(state, &size, sizeof size);
  if (!data.empty()) XXH3_64bits_update(state, data.data(), data.size() * sizeof(T));
}

inline std::string digest(const Scene& scene) {
  XXH3_state_t* state = XXH3_createState();
  XXH3_64bits_reset(state);
  for (const Mesh& mesh : scene.meshes) {
    for (const MeshPrimitive& p : mesh.primitives) {
      update(state, p.positions);
      update(state, p.normals);
      update(state, p.uvs);
      update(state, p.colors);
      update(state, p.indices);
    }
  }
  for (const Node& node : scene.nodes) {  // row by row
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 4; ++c) XXH3_64bits_update(state, &node.world_from_local[c][r], sizeof(float));
    }
  }
  for (const Texture& t : scene.materials.textures) update(state, t.rgba15);
  const std::uint64_t h = XXH3_64bits_digest(state);
  XXH3_freeState(state);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(h));
  return text;
}

}  // namespace shoal::test
