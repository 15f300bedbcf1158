// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// Makes points on open edges that are at most `distance` [m] apart one point: the one with the
/// lower number stays. Other points stay as they are, so that closed parts which touch keep apart.
/// Nothing is done where that would leave as many faulty edges as there are.
/// @return the number of points that became one with another
int weld_open_edges(TriangleSurface& surface, double distance);

}  // namespace plica
