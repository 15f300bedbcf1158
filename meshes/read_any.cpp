// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/format_of.hpp>
#include <plica/meshes/list.hpp>
#include <plica/meshes/read_any.hpp>
#include <plica/meshes/sound_mesh.hpp>
#include <plica/meshes/sound_surface.hpp>

namespace plica {

std::variant<ReadMesh, ReadSurface> read_any(const std::filesystem::path& path) {
  const auto holds = [](const auto& formats, const std::string& extension) {
    return std::ranges::any_of(formats, [&](const MeshFormat& format) { return extension == format.extension; });
  };
  std::vector<MeshFormat> formats(std::begin(mesh_formats), std::end(mesh_formats));
  for (const MeshFormat& format : surface_formats)
    if (!holds(mesh_formats, format.extension)) formats.push_back(format);
  const MeshFormat& format = format_of(path, formats, "mesh or surface");
  MeshReport report;
  const RawMesh raw = format.parse(load_file(path), report);
  const bool may_be_mesh = holds(mesh_formats, format.extension),
             may_be_surface = holds(surface_formats, format.extension);
  if (!may_be_mesh || (may_be_surface && raw.tets.empty() && !raw.triangles.empty())) {
    ReadSurface read;
    read.surface = sound_surface(raw, report, read.report);
    return read;
  }
  TetMesh mesh = sound_mesh(raw, report);
  return ReadMesh{std::move(mesh), std::move(report)};
}

}  // namespace plica
