// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/format_of.hpp>
#include <plica/meshes/list.hpp>
#include <plica/meshes/write_mesh.hpp>

namespace plica {

namespace {

template <class Writers>
const auto& writer_of(const std::filesystem::path& path, const Writers& writers, const std::string& kind,
                      const std::string& format, bool binary) {
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

WrittenMesh write_mesh(const std::filesystem::path& path, const TetMesh& mesh, const std::string& format, bool binary) {
  return writer_of(path, mesh_writers, "mesh", format, binary).write(path, mesh);
}

WrittenMesh write_surface(const std::filesystem::path& path, const TriangleSurface& surface, const std::string& format,
                          bool binary) {
  return writer_of(path, surface_writers, "surface", format, binary).write(path, surface);
}

}  // namespace plica
