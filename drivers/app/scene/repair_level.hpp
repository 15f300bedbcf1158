// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/meshes/files/raw_mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// A mesh that was read with Flaws::kept, repaired (see repair_mesh()); its report follows, and
/// gets a sentence for each thing that changed.
/// @param material  by which the step of the worst element is estimated, before and after
TetMesh repaired(const TetMesh& mesh, MeshReport& report, const MaterialOptions& material,
                 std::vector<std::string>& changes);

}  // namespace plica::app
