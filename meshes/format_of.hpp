// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/error.hpp>
#include <string>
#include <vector>

namespace plica {

/// The extension of a file without its dot, in lower case.
std::string extension_of(const std::filesystem::path& path);

/// The format of a list that the extension of a file names; InputError with the choices when none does. Formats have an
/// `extension`.
template <typename Formats>
const auto& format_of(const std::filesystem::path& path, const Formats& formats, const std::string& kind) {
  const std::string extension = extension_of(path);
  std::vector<std::string> choices;
  for (const auto& format : formats) {
    if (extension == format.extension) return format;
    if (choices.empty() || choices.back() != format.extension) choices.emplace_back(format.extension);
  }
  throw InputError(unknown_name(kind + " file extension", extension, choices), {path.string()});
}

}  // namespace plica
