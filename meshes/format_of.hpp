// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cctype>
#include <filesystem>
#include <plica/core/error.hpp>
#include <string>
#include <vector>

namespace plica {

/// The format of a list that the extension of a file names, in any case of letters; InputError with the choices when
/// none does. Formats have an `extension`.
template <typename Formats>
const auto& format_of(const std::filesystem::path& path, const Formats& formats, const std::string& kind) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::vector<std::string> choices;
  for (const auto& format : formats) {
    if (extension == format.extension) return format;
    if (choices.empty() || choices.back() != format.extension) choices.emplace_back(format.extension);
  }
  throw InputError(unknown_name(kind + " file extension", extension, choices), {path.string()});
}

}  // namespace plica
