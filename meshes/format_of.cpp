// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/format_of.hpp>
#include <plica/meshes/text_lines.hpp>

namespace plica {

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  return lower_case(extension);
}

}  // namespace plica
