// Tangents of a mesh that a normal map is read on, where the file gives none.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace shoal {

// A tangent in world space: along the surface as the transform bends it, unit (x where it degenerates), and its
// handedness turned by a mirror image.
Vec4f place_tangent(const Mat4& world_from_local, Vec4f tangent);

// Fills mesh.tangents. A vertex whose triangles are of both handednesses is doubled: the copy is appended to every
// array of the mesh, and the triangles of the second kind take it.
//
//   mesh  positions, unit normals and indices valid
//   uvs   one a vertex, of the normal map, its transform applied; v points down as in glTF
//
// The tangent of a triangle is the direction in which u grows; its handedness is 1 where u to the right has v down. At
// a vertex those of all triangles are summed that have the same position, normal, texture coordinates and handedness,
// each projected on the vertex's tangent plane, made unit, and weighted by the triangle's angle there. Where nothing
// is left, any direction across the normal.
// Source: glTF 2.0, 3.7.2.1 (MikkTSpace); Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", and his
// mikktspace.c. Differs: fans of triangles that meet in a vertex without sharing an edge are one group, not several;
// triangles without area in the texture take a group of their vertex as they are, and never make one's sign.
// Error: 2e-6 against double precision (tests/scene/test_tangents.cpp).
void generate_tangents(MeshPrimitive& mesh, const std::vector<Vec2f>& uvs);

}  // namespace shoal
