// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/written_mesh.hpp>

namespace plica {

/// Gmsh MSH files, text and binary. Regions become physical groups of volumes, vertex sets physical groups of points: what
/// parse_msh() makes of them is the same mesh, but for sets without a vertex.
WrittenMesh write_msh22(const std::filesystem::path& path, const TetMesh& mesh);
WrittenMesh write_msh41(const std::filesystem::path& path, const TetMesh& mesh);
WrittenMesh write_msh22_binary(const std::filesystem::path& path, const TetMesh& mesh);
WrittenMesh write_msh41_binary(const std::filesystem::path& path, const TetMesh& mesh);

}  // namespace plica
