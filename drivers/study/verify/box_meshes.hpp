// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <string>

// Boxes for tests of elements. Regular meshes hide much of an error.
namespace plica {

inline constexpr const char* mesh_kinds[] = {"regular", "jittered", "delaunay"};

/// Returns whether a mesh of this kind with these cells exists: of kind `delaunay` only those of
/// meshes/data/delaunay.
bool has_box(const std::string& kind, const std::array<int, 3>& cells);

/// Returns a mesh of a box. Kinds of mesh_kinds:
/// * regular: six tetrahedra per cell;
/// * jittered: vertices moved by up to a fifth of a cell, those on a face within that face;
/// * delaunay: Delaunay tetrahedra, with slivers, of as many vertices, moved by up to 0.35 cells.
/// @param kept  axis at whose upper end vertices are not moved; -1: none
TetMesh box_of(const std::string& kind, const Box& box, const std::array<int, 3>& cells,
               int kept = -1);

}  // namespace plica
