// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/level.hpp>
#include <plica/core/load.hpp>
#include <plica/drivers/body/selection.hpp>
#include <vector>

namespace plica {

/// Whether no vertex on a rim of these triangles moves: they enclose a volume then, up to a
/// constant.
bool has_still_rims(const std::vector<std::array<int, 3>>& triangles,
                    const std::vector<char>& still);

/// The mean of their corners at rest [m].
Point centre_of(const TetMesh& mesh, const std::vector<std::array<int, 3>>& triangles);

/// What triangles of a mesh at rest enclose on their outer side. A rim is closed by a fan about its
/// middle, so it must not move: `still` says which vertices do not. `load` is its number.
/// InputError where others are on it, or where no volume is enclosed.
Cavity make_cavity(const EnclosedVolume& given, int load, const TetMesh& mesh,
                   const std::vector<std::array<int, 3>>& triangles, const std::vector<char>& still,
                   const Selecting& who);

/// An upper bound of what the fluids in a level's cavities add to its squared frequencies [1/s^2]:
/// the stiffness of one is K a a^T / V with a = dV/dx, which is as large as areas: those at rest,
/// grown to `ratio` alike in all directions where that is above 1.
template <class B>
double cavity_eigenvalue(const Level<B>& level);

}  // namespace plica
