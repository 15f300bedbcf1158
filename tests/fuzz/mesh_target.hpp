// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <filesystem>
#include <plica/core/error.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <string>

#include "target.hpp"

namespace plica::fuzz {

// Whatever their numbers are
inline bool same_regions(const std::vector<int>& a, const std::vector<int>& b) {
  std::map<int, int> there, back;
  for (std::size_t t = 0; t < a.size() && t < b.size(); ++t)
    if (there.try_emplace(a[t], b[t]).first->second != b[t] ||
        back.try_emplace(b[t], a[t]).first->second != a[t])
      return false;
  return a.size() == b.size();
}

// Written and read again a mesh is the same, unless its names cannot be written
inline void check_written(const TetMesh& mesh, const MeshGroups& groups) {
  for (const MeshWriter& writer : mesh_writers) {
    if (std::string_view(writer.name) == "tetgen") continue;  // two files
    WrittenMesh written;
    try {
      written = writer.write(std::string("m.") + writer.extension, mesh, groups);
    } catch (const InputError&) {
      continue;
    }
    const TetMesh again = read_mesh(written.files.front());
    require(again.vertices == mesh.vertices && again.tets == mesh.tets &&
                same_regions(again.region, mesh.region),
            "a mesh that was written and read again");
  }
}

inline void mesh(const char* name, std::string_view bytes) {
  try {
    MeshReport report;
    const TetMesh mesh = read_mesh(FileBytes{name, std::string(bytes)}, &report);
    check(mesh);
    check_written(mesh, report.groups);
  } catch (const InputError&) {
  }
}

inline void surface(const char* name, std::string_view bytes) {
  try {
    SurfaceReport report;
    const TriangleSurface surface = read_surface(FileBytes{name, std::string(bytes)}, &report);
    require(!surface.triangles.empty(), "no triangle");
    for (const auto& triangle : surface.triangles)
      for (const int v : triangle)
        static_cast<void>(surface.vertices.at(static_cast<std::size_t>(v)));
  } catch (const InputError&) {
  }
}

// Both files in one, the elements before a '%'
inline void tetgen(std::string_view bytes) {
  const std::size_t cut = std::min(bytes.find('%'), bytes.size());
  const FileBytes elements{"m.ele", std::string(bytes.substr(0, cut))};
  const FileBytes nodes{"m.node", std::string(bytes.substr(std::min(cut + 1, bytes.size())))};
  try {
    MeshReport report;
    check(validated_mesh(parse_tetgen(elements, nodes, report), report));
  } catch (const InputError&) {
  }
}

inline constexpr Target mesh_targets[] = {
    {"msh", [](std::string_view bytes) { mesh("m.msh", bytes), surface("m.msh", bytes); }},
    {"medit", [](std::string_view bytes) { mesh("m.mesh", bytes), surface("m.mesh", bytes); }},
    {"vtk", [](std::string_view bytes) { mesh("m.vtk", bytes), surface("m.vtk", bytes); }},
    {"vtu", [](std::string_view bytes) { mesh("m.vtu", bytes), surface("m.vtp", bytes); }},
    {"tetgen", tetgen},
    {"inp", [](std::string_view bytes) { mesh("m.inp", bytes), surface("m.inp", bytes); }},
    {"feb", [](std::string_view bytes) { mesh("m.feb", bytes), surface("m.feb", bytes); }},
    {"obj", [](std::string_view bytes) { surface("m.obj", bytes); }},
    {"ply", [](std::string_view bytes) { surface("m.ply", bytes); }},
    {"off", [](std::string_view bytes) { surface("m.off", bytes); }},
    {"stl", [](std::string_view bytes) { surface("m.stl", bytes); }},
};

}  // namespace plica::fuzz
