// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/meshes/composite.hpp>
#include <vector>

/// A mesh some of whose tetrahedra are cut in eight. Other tetrahedra may be chosen later: a vertex
/// keeps its name, the two vertices of the mesh that it is in the middle of.
namespace plica {

/// The two vertices of a mesh that a vertex of partly_refined() is in the middle of, ascending;
/// twice the same: it is at that one.
using Ends = std::array<int, 2>;

/// Returns a mesh with some of its tetrahedra cut in eight each. Vertices at the border follow the
/// others, see compose(). Without any it is the mesh itself, with all of them refined().
/// @param mesh  mesh of one piece
/// @param tets  numbers of tetrahedra, ascending
Composite partly_refined(const TetMesh& mesh, const std::vector<int>& tets);

/// Returns the ends of each vertex of partly_refined(). At the border a vertex of the mesh is there
/// twice: as a corner of what is cut, and, later, of what is not.
std::vector<Ends> ends_of_vertices(const TetMesh& mesh, const std::vector<int>& tets);

/// Returns the values of a mesh's own vertices from those of partly_refined(). Where a vertex is
/// there twice, that of the later one, which the other one follows.
std::vector<Point> values_at_vertices(const std::vector<Ends>& ends,
                                      const std::vector<Point>& values, std::size_t vertices);

/// Carries values of vertices from one choice of tetrahedra to another. A vertex that both have
/// keeps its value. One that is new gets the mean of its ends, so that a field stays as it is where
/// tetrahedra are cut.
/// @param from      ends of the vertices that have the values
/// @param to        ends of the vertices that get them
/// @param vertices  number of vertices of the mesh
std::vector<Point> carried_values(const std::vector<Ends>& from, const std::vector<Point>& values,
                                  const std::vector<Ends>& to, std::size_t vertices);

/// Returns the tetrahedra whose centroid is within a distance of a point, ascending.
/// @param places  places of the vertices [m]
std::vector<int> tets_within(const std::vector<std::array<int, 4>>& tets,
                             const std::vector<Point>& places, const Point& centre, double radius);

}  // namespace plica
