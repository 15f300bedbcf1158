// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/raw_mesh.hpp>

namespace plica {

/// Takes the tetrahedra of a pair of files by TetGen (its manual, "File formats"): NAME.node and NAME.ele, numbered from 0
/// or 1.
///
/// Region 3 is what has 3 as its first attribute, and named "attribute_3"; where all are 0 or there is none, there is one
/// nameless region. Vertices with the boundary marker 2 are the set "marker_2"; 0 marks none. Coordinates are taken as
/// metres.
///
/// Strict, as parse_msh(). Neither file has an end mark, but a comment: their first line tells how long they are.
RawMesh parse_tetgen(const MemoryFile& elements, const MemoryFile& nodes, MeshReport& report);

/// The same with one of the two; the other one lies beside it.
RawMesh parse_tetgen(const MemoryFile& file, MeshReport& report);

}  // namespace plica
