// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/written_mesh.hpp>

namespace plica {

/// Wavefront OBJ, and STL, text and binary; the binary one keeps seven digits of the coordinates.
WrittenMesh write_obj(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_stl(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_stl_binary(const std::filesystem::path& path, const TriangleSurface& surface);

}  // namespace plica
