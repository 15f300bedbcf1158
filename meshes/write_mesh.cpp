// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <plica/meshes/format_of.hpp>
#include <plica/meshes/list.hpp>
#include <plica/meshes/write_mesh.hpp>

namespace plica {

namespace {

const MeshWriter& writer_of(const std::filesystem::path& path, const std::string& format) {
  const MeshWriter& first = format_of(path, mesh_writers, "mesh");
  if (format.empty()) return first;
  std::vector<std::string> choices;
  for (const MeshWriter& writer : mesh_writers) {
    if (std::string_view(writer.extension) != first.extension) continue;
    if (format == writer.name) return writer;
    choices.emplace_back(writer.name);
  }
  throw InputError(unknown_name("format", format, choices), {path.string()});
}

}  // namespace

std::vector<std::string> write_mesh(const std::filesystem::path& path, const TetMesh& mesh, const std::string& format) {
  const WrittenMesh written = writer_of(path, format).write(path, mesh);
  for (const MemoryFile& file : written.files) {
    std::ofstream out(file.name, std::ios::binary);
    out.write(file.bytes.data(), static_cast<std::streamsize>(file.bytes.size()));
    if (!out.flush()) throw InputError("cannot be written", {file.name});
  }
  return written.left_out;
}

}  // namespace plica
