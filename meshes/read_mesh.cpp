// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/format_of.hpp>
#include <plica/meshes/list.hpp>
#include <plica/meshes/read_mesh.hpp>
#include <plica/meshes/sound_mesh.hpp>

namespace plica {

TetMesh read_mesh(const std::filesystem::path& path, MeshReport* report) {
  format_of(path, mesh_formats, "mesh");  // a wrong extension is told before the file is looked for
  return read_mesh(load_file(path), report);
}

TetMesh read_mesh(const MemoryFile& file, MeshReport* report) {
  MeshReport found;
  const RawMesh raw = format_of(file.name, mesh_formats, "mesh").parse(file, found);
  TetMesh mesh = sound_mesh(raw, found);
  if (report) *report = std::move(found);
  return mesh;
}

}  // namespace plica
