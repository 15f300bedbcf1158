// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>

namespace plica {

/// A box of cells, each cut into six tetrahedra around the diagonal from its lowest to its highest corner.
/// Vertices are numbered x fastest; the outermost lie exactly on the box.
///
/// @param box    both ends finite [m], min below max along every axis; InputError otherwise
/// @param cells  per axis, 1 or more; InputError otherwise, or when a count does not fit an int
/// @return       prod(cells + 1) vertices, 6 prod(cells) tetrahedra
TetMesh box_mesh(const Box& box, const std::array<int, 3>& cells);

}  // namespace plica
