// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <plica/core/error.hpp>
#include <plica/meshes/list.hpp>
#include <plica/meshes/read_mesh.hpp>

namespace plica {

TetMesh read_mesh(const std::filesystem::path& path, MeshReport* report) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::vector<std::string> choices;
  for (const MeshFormat& format : mesh_formats) {
    if (extension == format.extension) return format.read(path, report);
    choices.emplace_back(format.extension);
  }
  throw InputError(unknown_name("mesh file extension", extension, choices), {path.string()});
}

}  // namespace plica
