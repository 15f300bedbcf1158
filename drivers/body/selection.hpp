// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/problem.hpp>
#include <plica/core/selection.hpp>
#include <string>
#include <vector>

namespace plica {

/// Who selects, for messages: the option as a scene names it ("body.fixed.0") and the level.
struct Selecting {
  std::string option;
  int level = 0;
};

/// The vertices of a mesh at rest that a selection chooses, ascending; at least one. InputError
/// where there is none, or no group of that name.
std::vector<int> select_vertices(const TetMesh& mesh, const Selection& selection,
                                 const Selecting& who);

/// The points of a surface, where they start, that a selection chooses, ascending; at least one.
/// InputError where there is none, and for groups and regions, which a surface has not.
std::vector<int> select_points(const std::vector<Point>& points, const Selection& selection,
                               const std::string& option);
/// of a group or region: InputError
void expect_without_name(const Selection& selection, const std::string& option);

/// The elements whose centroid it chooses, or of the region it names; likewise.
std::vector<int> select_elements(const TetMesh& mesh, const Selection& selection,
                                 const Selecting& who);

/// The boundary triangles all of whose vertices it chooses; likewise.
std::vector<std::array<int, 3>> select_triangles(const TetMesh& mesh, const Selection& selection,
                                                 const Selecting& who);

/// Gives a mesh at rest the regions that are chosen by a selection. InputError where two choose one
/// element, where one chooses none, or where the mesh has a region of that name of its own.
void add_regions(TetMesh& mesh, const std::map<std::string, RegionOptions>& regions, int level);

}  // namespace plica
