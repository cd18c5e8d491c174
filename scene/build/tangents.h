// Generates the tangents of a mesh with a normal map where the file has none.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace shoal {

// Transforms a tangent to world space.
//   tangent  local direction in x, y, z; handedness 1 or -1 in w
// Returns the unit direction (+x where it degenerates) and the handedness, reversed where the transform mirrors.
Vec4f place_tangent(const Mat4& world_from_local, Vec4f tangent);

// Fills mesh.tangents. A vertex whose triangles have both handednesses is doubled: the copy is appended to every array
// of the mesh, and the triangles of the second handedness use it.
//
//   mesh  positions, unit normals and indices valid
//   uvs   texture coordinates of the normal map, one a vertex, its transform applied; v points down as in glTF
//
// The tangent of a triangle is the direction in which u increases; its handedness is 1 where v points down when u
// points right. The tangent at a vertex is the sum over all triangles with the same position, normal, texture
// coordinates and handedness, each projected onto the vertex's tangent plane, normalized, and weighted by the
// triangle's angle there. A sum of zero is replaced by a direction perpendicular to the normal.
// Source: glTF 2.0, 3.7.2.1 (MikkTSpace); Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", and his
// mikktspace.c.
// Differs: fans of triangles that meet in a vertex without sharing an edge form one group, not several; triangles
// without area in the texture use an existing group of their vertex and do not determine its handedness.
// Error: 2e-6 against double precision (tests/scene/test_tangents.cpp).
void generate_tangents(MeshPrimitive& mesh, const std::vector<Vec2f>& uvs);

}  // namespace shoal
