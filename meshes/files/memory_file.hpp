// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <plica/core/error.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// A file in memory.
struct MemoryFile {
  std::string name;  ///< as errors show it; its extension tells the format
  std::string bytes;
};

/// Reads all of it; InputError with the system's reason when that cannot be, and for folders, pipes
/// and devices.
MemoryFile load_file(const std::filesystem::path& path);

/// Where in a file something stands: on a line, or, where a file is binary, at a byte.
struct Place {
  std::int64_t line = 0;   ///< from 1; 0: none
  std::int64_t byte = -1;  ///< from 0; -1: none
};

/// "on line 3", "at byte 120", or nothing for no place
std::string to_text(const Place& place);

/// InputError "FILE:LINE: MESSAGE", or "FILE: byte N: MESSAGE".
[[noreturn]] void refuse(const std::string& file, const Place& place, const std::string& message);

/// Input as an error shows it: in quotes, without control characters, cut when it is long.
std::string shown(std::string_view input);

/// The extension of a file without its dot, in lower case.
std::string extension_of(const std::filesystem::path& path);

/// The format of a list that the extension of a file names; InputError with the choices when none
/// does. Formats have an `extension`.
template <typename Formats>
const auto& format_of(const std::filesystem::path& path, const Formats& formats,
                      const std::string& kind) {
  const std::string extension = extension_of(path);
  std::vector<std::string> choices;
  for (const auto& format : formats) {
    if (extension == format.extension) return format;
    if (choices.empty() || choices.back() != format.extension)
      choices.emplace_back(format.extension);
  }
  throw InputError(unknown_name(kind + " file extension", extension, choices), {path.string()});
}

/// A way in which VTK compresses blocks of arrays.
struct Compressor {
  const char* name;           ///< as files have it
  std::size_t largest_ratio;  ///< of what comes out to what goes in: more is a lie
  /// The `size` bytes that a block holds; nothing when it does not.
  std::optional<std::string> (*decompress)(std::string_view block, std::size_t size);
};

/// The one of that name; null for none.
const Compressor* find_compressor(std::string_view name);

/// Their names, "A and B".
std::string compressor_names();

}  // namespace plica
