// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>

namespace plica {

/// Gives a mesh at rest the regions that are chosen by a selection. InputError where two choose one element, where one chooses
/// none, or where the mesh has a region of that name of its own.
void add_regions(TetMesh& mesh, const std::map<std::string, RegionOptions>& regions, int level);

}  // namespace plica
