// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/problem.hpp>
#include <plica/core/selection.hpp>
#include <string>
#include <vector>

namespace plica {

/// Returns the distance within which two places count as one, for a body of this size [m]. Files
/// keep places in single precision, and what is turned into place is rounded.
constexpr double same_place(double size) { return 1e-6 * size; }
/// Returns it for the diagonal of a box.
inline double same_place(const Box& box) { return same_place((box.max - box.min).norm()); }

/// Option that selects, for messages: as a scene names it ("body.fixed.0"), and the level.
struct Selecting {
  std::string option;
  int level = 0;
};

/// Choice of faces that cuts have opened, among the boundary triangles.
enum class OpenedFaces {
  left_out,  ///< no: the surface that the body had before all cuts
  included   ///< yes
};

/// Returns the vertices of a mesh at rest that a selection chooses, ascending; at least one.
/// Vertices that follow others are never chosen. Throws InputError where there is none, or no group
/// of that name.
std::vector<int> select_vertices(const TetMesh& mesh, const Selection& selection,
                                 const Selecting& who);

/// Returns the points of a surface that a selection chooses where they start, ascending; at least
/// one. Throws InputError where there is none, and for groups and regions, which a surface does not
/// have.
std::vector<int> select_points(const std::vector<Point>& points, const Selection& selection,
                               const std::string& option);
/// Throws InputError for a selection by the name of a group or region.
void expect_without_name(const Selection& selection, const std::string& option);

/// Returns the elements whose centroid a selection chooses, or of the region it names, ascending;
/// at least one. Throws InputError where there is none, or no region of that name.
std::vector<int> select_elements(const TetMesh& mesh, const Selection& selection,
                                 const Selecting& who);

/// Returns the boundary triangles that a selection chooses, at least one. These are the triangles
/// of a group that has some (TetMesh::triangle_sets), else those all of whose vertices are chosen.
/// Faces that cuts have opened are not chosen by their vertices, unless `opened` says so.
/// Throws InputError where there is none, or no group of that name. Throws it also for a lattice,
/// whose faces are not the body's.
std::vector<std::array<int, 3>> select_triangles(const TetMesh& mesh, const Selection& selection,
                                                 const Selecting& who,
                                                 OpenedFaces opened = OpenedFaces::left_out);

/// Gives a mesh at rest the regions that are chosen by a selection. Throws InputError where two
/// choose one element, where one chooses none, or where the mesh has a region of that name of its
/// own.
void add_regions(TetMesh& mesh, const std::map<std::string, RegionOptions>& regions, int level);

}  // namespace plica
