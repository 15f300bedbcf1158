// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/composite.hpp>
#include <string>
#include <vector>

namespace plica {

/// Returns for each boundary triangle of a part whether it is border; the others are skin. See
/// compose().
/// @param boundary  boundary triangles of the part
/// @param coarser   mesh that the part is compared with, where nothing says which are skin
/// @param border    name of a set of the part, or empty
std::vector<char> border_flags(const PartMesh& part,
                               const std::vector<std::array<int, 3>>& boundary,
                               const TetMesh& coarser, const std::string& border);

}  // namespace plica
