// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/written_mesh.hpp>

namespace plica {

/// NAME.node and NAME.ele, numbered from 1. Regions are the attribute of tetrahedra; vertex sets are boundary markers, of
/// which a vertex has one at most.
WrittenMesh write_tetgen(const std::filesystem::path& path, const TetMesh& mesh);

}  // namespace plica
