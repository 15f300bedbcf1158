// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/read_mesh.hpp>
#include <plica/meshes/read_surface.hpp>
#include <variant>

namespace plica {

struct ReadMesh {
  TetMesh mesh;
  MeshReport report;
};
struct ReadSurface {
  TriangleSurface surface;
  SurfaceReport report;
};

/// Reads what a file holds: a mesh, or, where it has triangles and no tetrahedron, a surface.
/// @throw InputError as read_mesh() and read_surface() do
std::variant<ReadMesh, ReadSurface> read_any(const std::filesystem::path& path);

}  // namespace plica
