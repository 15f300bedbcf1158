// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/files/parsed_mesh.hpp>

namespace plica {

/// Replaces each second-order tetrahedron by eight linear ones: one at each corner, and four around
/// the shortest diagonal of what is left between the nodes on the edges. Groups of lines and
/// triangles on their edges are split alike. So every node of the file is a vertex of the mesh.
///
/// Each node belongs to the edge whose middle is nearest: formats differ in the order of these
/// nodes. Nothing is done where the file has other cells, too: their common faces would not fit.
/// @throw InputError for nodes that are not one at each edge
void split_second_order(ParsedMesh& raw, MeshReport& report);

}  // namespace plica
