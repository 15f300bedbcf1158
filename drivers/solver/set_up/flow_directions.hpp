// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Of each tetrahedron of level 0 the direction in which heat would flow from `from`, kept at 0, to `to`, kept at 1, through a body that
/// leads it alike everywhere and loses none: the gradient of its temperature. Where the gradient is nothing, in a corner that lies in one set
/// or in a dead end, that of the elements beside it. `path` is the option for messages. InputError where a set is not there, where a vertex is
/// in both, and where a part of the body touches only one of them.
std::vector<Point> flow_directions(const TetMesh& mesh, const Selection& from, const Selection& to,
                                   const std::string& path);

}  // namespace plica
