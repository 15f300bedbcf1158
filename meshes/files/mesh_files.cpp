// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/files/validated_mesh.hpp>

namespace plica {

TetMesh read_mesh(const std::filesystem::path& path, MeshReport* report, Flaws flaws) {
  format_of(path, mesh_formats, "mesh");  // reports a wrong extension before a missing file
  return read_mesh(load_file(path), report, flaws);
}

TetMesh read_mesh(const FileBytes& file, MeshReport* report, Flaws flaws) {
  MeshReport found;
  const ParsedMesh raw = format_of(file.name, mesh_formats, "mesh").parse(file, found);
  TetMesh mesh = validated_mesh(raw, found, flaws);
  if (report) *report = std::move(found);
  return mesh;
}

TriangleSurface read_surface(const std::filesystem::path& path, SurfaceReport* report) {
  // reports a wrong extension before a missing file
  format_of(path, surface_formats, "surface");
  return read_surface(load_file(path), report);
}

TriangleSurface read_surface(const FileBytes& file, SurfaceReport* report) {
  MeshReport found;
  SurfaceReport repaired;
  const ParsedMesh raw = format_of(file.name, surface_formats, "surface").parse(file, found);
  TriangleSurface surface = validated_surface(raw, found, repaired);
  if (report) *report = std::move(repaired);
  return surface;
}

std::variant<ReadMesh, ReadSurface> read_any(const std::filesystem::path& path) {
  const auto holds = [](const auto& formats, const std::string& extension) {
    return std::ranges::any_of(
        formats, [&](const MeshFormat& format) { return extension == format.extension; });
  };
  std::vector<MeshFormat> formats(std::begin(mesh_formats), std::end(mesh_formats));
  for (const MeshFormat& format : surface_formats)
    if (!holds(mesh_formats, format.extension)) formats.push_back(format);
  const MeshFormat& format = format_of(path, formats, "mesh or surface");
  MeshReport report;
  const ParsedMesh raw = format.parse(load_file(path), report);
  const bool may_be_mesh = holds(mesh_formats, format.extension),
             may_be_surface = holds(surface_formats, format.extension);
  if (!may_be_mesh ||
      (may_be_surface && raw.tets.empty() && raw.triangles.size() + raw.polygons.size() > 0)) {
    ReadSurface read;
    read.surface = validated_surface(raw, report, read.report);
    return read;
  }
  TetMesh mesh = validated_mesh(raw, report);
  return ReadMesh{std::move(mesh), std::move(report)};
}

namespace {

template <class Writers>
const auto& writer_of(const std::filesystem::path& path, const Writers& writers,
                      const std::string& kind, const std::string& format, bool binary) {
  const std::string_view extension = format_of(path, writers, kind).extension;
  std::vector<std::string> names;
  bool known = false;
  for (const auto& writer : writers) {
    if (writer.extension != extension) continue;
    if (names.empty() || names.back() != writer.name) names.emplace_back(writer.name);
    if (!format.empty() && format != writer.name) continue;
    known = true;
    if (writer.binary || !binary) return writer;
  }
  if (known) throw InputError("this format has no binary form here", {path.string()});
  throw InputError(unknown_name("format", format, names), {path.string()});
}

}  // namespace

WrittenMesh write_mesh(const std::filesystem::path& path, const TetMesh& mesh,
                       const std::string& format, bool binary, const MeshGroups& groups) {
  return writer_of(path, mesh_writers, "mesh", format, binary).write(path, mesh, groups);
}

WrittenMesh write_surface(const std::filesystem::path& path, const TriangleSurface& surface,
                          const std::string& format, bool binary) {
  return writer_of(path, surface_writers, "surface", format, binary).write(path, surface);
}

}  // namespace plica
