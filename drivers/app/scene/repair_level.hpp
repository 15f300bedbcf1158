// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Returns the repaired mesh of one that was read with Flaws::kept, see repair_mesh().
/// @param report    report of the mesh; its numbers and groups are updated to the repaired mesh
/// @param material  material for the estimate of the worst element's step, before and after
/// @param changes   gets a sentence for each kind of change
TetMesh repaired(const TetMesh& mesh, MeshReport& report, const MaterialOptions& material,
                 std::vector<std::string>& changes);

}  // namespace plica::app
