// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/raw_mesh.hpp>
#include <plica/meshes/surface_report.hpp>

namespace plica {

/// The one way from a file to a surface: its triangles, whatever else it holds. Open surfaces and those that are no
/// manifold are taken and counted: whether they will do is for the caller to say.
///
/// @param found  what the parser found
/// @throw InputError with the place: no triangle; quadrangles besides; a coordinate that is not finite; a vertex defined
///        twice, or not at all; a triangle without area (twice the area is at most 1e-12 of the longest edge squared)
TriangleSurface sound_surface(const RawMesh& raw, const MeshReport& found, SurfaceReport& report);

/// Adds its edges that keep a surface from having an inside to the report.
void count_edges(const TriangleSurface& surface, SurfaceReport& report);

}  // namespace plica
