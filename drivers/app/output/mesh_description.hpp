// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <string>
#include <vector>

/// Output of `plica mesh info`: text in 100 columns, or JSON.
namespace plica::app {

/// Data about a mesh file that `plica mesh info` prints.
struct MeshDescription {
  std::string file;
  ReadMesh read;
  MeshQuality quality;
  std::vector<std::string> warnings;
  MaterialOptions material;
  /// largest stable step of symplectic Euler with `material`, without contact [s]
  double critical_step = 0;
  double element_bound = 0;          ///< lower bound of critical_step, from the worst element [s]
  std::vector<double> worst_bounds;  ///< step of each element of quality.worst by itself [s]
};
/// Returns the description of a mesh as text in 100 columns.
std::string mesh_text(const MeshDescription& mesh);
/// Returns the description of a mesh as JSON.
std::string mesh_json(const MeshDescription& mesh);

/// Data about a surface file that `plica mesh info` prints.
struct SurfaceDescription {
  std::string file;
  ReadSurface read;
  std::vector<std::string> warnings;
};
/// Returns the description of a surface as text in 100 columns.
std::string surface_text(const SurfaceDescription& surface);
/// Returns the description of a surface as JSON.
std::string surface_json(const SurfaceDescription& surface);

}  // namespace plica::app
