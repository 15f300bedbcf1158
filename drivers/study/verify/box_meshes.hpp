// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <string>

// Boxes that elements are judged on. Regular ones hide much of an error.
namespace plica {

inline constexpr const char* mesh_kinds[] = {"regular", "jittered", "delaunay"};

/// Whether such a mesh of so many cells was made: of `delaunay` there are those of
/// meshes/data/delaunay.
bool has_box(const std::string& kind, const std::array<int, 3>& cells);

/// regular: six tetrahedra a cell; jittered: its vertices moved by up to a fifth of a cell, those
/// on a face within it, those at the upper end of the axis `kept` not at all; delaunay: Delaunay's
/// tetrahedra of as many vertices, moved by up to 0.35, slivers and all.
TetMesh box_of(const std::string& kind, const Box& box, const std::array<int, 3>& cells,
               int kept = -1);

}  // namespace plica
