// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/raw_mesh.hpp>

namespace plica {

/// Takes the cells of an unstructured grid of VTK's legacy format ("VTK file formats" in its documentation), versions 1.0
/// to 5.1, text or binary.
///
/// Regions are told by the cells' array of integers named "region", or else by the first one with an integer per cell.
/// Points and cells have the numbers they have in the file, from 0. Coordinates are taken as metres.
///
/// Strict, as parse_msh(). The format has no end mark: a file that is cut between two arrays looks whole.
RawMesh parse_vtk(const MemoryFile& file, MeshReport& report);

}  // namespace plica
