// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/files/format_by_content.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/files/validated_mesh.hpp>

namespace plica {

namespace {

// Loads a file. A wrong extension is reported before a missing file
template <class Formats>
FileBytes loaded(const std::filesystem::path& path, const Formats& formats,
                 const std::string& kind) {
  if (std::error_code error; !std::filesystem::exists(path, error)) format_of(path, formats, kind);
  return load_file(path);
}

// Parses a file in the format that its first bytes tell, else its extension
template <class Formats>
ParsedMesh parsed(const FileBytes& file, const Formats& formats, const std::string& kind,
                  MeshReport& report, const MeshFormat** taken = nullptr) {
  const std::optional<KnownContent> content = known_content(file.bytes);
  const MeshFormat* format = nullptr;
  if (!content || content->names(extension_of(file.name))) {
    format = &format_of(file.name, formats, kind);
  } else {
    for (const MeshFormat& one : formats)
      if (!format && content->extension == one.extension) format = &one;
    const std::string by_content = "is " + content->description + " by its first bytes";
    if (!format)
      refuse(file.name, {},
             by_content + "; expected a " + kind + " file" +
                 (content->advice.empty() ? "" : ": " + content->advice));
    report.notes.push_back(by_content + ", whatever its name says, and is read so");
  }
  if (taken) *taken = format;
  return format->parse(file, report);
}

}  // namespace

TetMesh read_mesh(const std::filesystem::path& path, MeshReport* report,
                  const ReadOptions& options) {
  return read_mesh(loaded(path, mesh_formats, "mesh"), report, options);
}

TetMesh read_mesh(const FileBytes& file, MeshReport* report, const ReadOptions& options) {
  MeshReport found;
  TetMesh mesh = validated_mesh(parsed(file, mesh_formats, "mesh", found), found, options);
  if (report) *report = std::move(found);
  return mesh;
}

TriangleSurface read_surface(const std::filesystem::path& path, SurfaceReport* report,
                             double weld) {
  return read_surface(loaded(path, surface_formats, "surface"), report, weld);
}

TriangleSurface read_surface(const FileBytes& file, SurfaceReport* report, double weld) {
  MeshReport found;
  SurfaceReport repaired;
  const ParsedMesh raw = parsed(file, surface_formats, "surface", found);
  TriangleSurface surface = validated_surface(raw, found, repaired, weld);
  if (report) *report = std::move(repaired);
  return surface;
}

std::variant<ReadMesh, ReadSurface> read_any(const std::filesystem::path& path,
                                             const ReadOptions& options) {
  const auto holds = [](const auto& formats, const std::string& extension) {
    return std::ranges::any_of(
        formats, [&](const MeshFormat& format) { return extension == format.extension; });
  };
  std::vector<MeshFormat> formats(std::begin(mesh_formats), std::end(mesh_formats));
  for (const MeshFormat& format : surface_formats)
    if (!holds(mesh_formats, format.extension)) formats.push_back(format);
  constexpr const char* kind = "mesh or surface";
  MeshReport report;
  const MeshFormat* format = nullptr;
  ParsedMesh raw = parsed(loaded(path, formats, kind), formats, kind, report, &format);
  const bool may_be_mesh = holds(mesh_formats, format->extension),
             may_be_surface = holds(surface_formats, format->extension);
  if (!may_be_mesh ||
      (may_be_surface && raw.tets.empty() && raw.triangles.size() + raw.polygons.size() > 0)) {
    ReadSurface read;
    read.surface = validated_surface(raw, report, read.report, options.weld);
    return read;
  }
  TetMesh mesh = validated_mesh(std::move(raw), report, options);
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

// Throws InputError where a tetrahedron is in a region without a name, or has corners that are no
// vertices
void expect_known_numbers(const std::filesystem::path& path, const TetMesh& mesh) {
  const auto expect = [&](bool known, std::size_t tet, const char* what, int number,
                          std::size_t count) {
    if (!known)
      throw InputError("tetrahedron " + std::to_string(tet) + " has " + what + " " +
                           std::to_string(number) + "; the mesh has " + std::to_string(count) +
                           ", counted from 0",
                       {path.string()});
  };
  const auto below = [](int number, std::size_t count) {
    return number >= 0 && static_cast<std::size_t>(number) < count;
  };
  const std::size_t points = mesh.vertices.size(), regions = mesh.region_names.size();
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    for (const int corner : mesh.tets[e])
      expect(below(corner, points), e, "vertex", corner, points);
  if (!mesh.region.empty() && mesh.region.size() != mesh.tets.size())
    throw InputError("the mesh has " + std::to_string(mesh.tets.size()) +
                         " tetrahedra and regions for " + std::to_string(mesh.region.size()),
                     {path.string()});
  for (std::size_t e = 0; e < mesh.region.size(); ++e)
    expect(below(mesh.region[e], regions), e, "region", mesh.region[e], regions);
}

}  // namespace

WrittenMesh write_mesh(const std::filesystem::path& path, const TetMesh& mesh,
                       const std::string& format, bool binary, const MeshGroups& groups) {
  expect_known_numbers(path, mesh);
  return writer_of(path, mesh_writers, "mesh", format, binary).write(path, mesh, groups);
}

WrittenMesh write_surface(const std::filesystem::path& path, const TriangleSurface& surface,
                          const std::string& format, bool binary) {
  const SurfaceWriter& writer = writer_of(path, surface_writers, "surface", format, binary);
  WrittenMesh written = writer.write(path, surface);
  if (!surface.texture.empty() && writer.write != write_obj)
    written.left_out.push_back("the texture coordinates are left out: this format has none");
  return written;
}

}  // namespace plica
