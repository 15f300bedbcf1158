// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/level_data.hpp>
#include <plica/core/load.hpp>
#include <plica/drivers/body/selection.hpp>
#include <vector>

namespace plica {

/// Returns whether no vertex on a rim of these triangles moves. If so, they enclose a volume, up to
/// a constant.
bool has_still_rims(const std::vector<std::array<int, 3>>& triangles,
                    const std::vector<char>& still);

/// Returns the mean of the triangles' corners at rest [m].
Point centre_of(const TetMesh& mesh, const std::vector<std::array<int, 3>>& triangles);

/// Makes the cavity that triangles of a mesh at rest enclose on their outer side. A rim is closed
/// by a fan about its middle, so it must not move. Throws InputError where a vertex on a rim may
/// move, or where no volume is enclosed.
/// @param load   number of the load
/// @param still  for each vertex whether it never moves
Cavity make_cavity(const EnclosedVolume& given, int load, const TetMesh& mesh,
                   const std::vector<std::array<int, 3>>& triangles, const std::vector<char>& still,
                   const Selecting& who);

}  // namespace plica
