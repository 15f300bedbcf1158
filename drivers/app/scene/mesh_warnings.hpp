// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/meshes/files/raw_mesh.hpp>
#include <plica/meshes/surface_report.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// What a user should know about a mesh that was read, a sentence each: what was repaired, left out, or looks wrong.
std::vector<std::string> mesh_warnings(const TetMesh& mesh, const MeshReport& report);
std::vector<std::string> surface_warnings(const SurfaceReport& report);

}  // namespace plica::app
