// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <string>
#include <vector>

/// What `plica mesh info` tells, in 100 columns for people and as JSON for programs.
namespace plica::app {

struct MeshDescription {
  std::string file;
  ReadMesh read;
  MeshQuality quality;
  std::vector<std::string> warnings;
  MaterialOptions material;
  /// with that material, of symplectic Euler, without contact [s]
  double critical_step = 0;
  double element_bound = 0;          ///< the same from the worst single element [s]
  std::vector<double> worst_bounds;  ///< of each of quality.worst alone [s]
};
std::string mesh_text(const MeshDescription& mesh);
std::string mesh_json(const MeshDescription& mesh);

struct SurfaceDescription {
  std::string file;
  ReadSurface read;
  std::vector<std::string> warnings;
};
std::string surface_text(const SurfaceDescription& surface);
std::string surface_json(const SurfaceDescription& surface);

}  // namespace plica::app
