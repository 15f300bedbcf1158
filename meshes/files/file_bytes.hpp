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

/// File in memory.
struct FileBytes {
  std::string name;  ///< file name in errors; its extension names the format
  std::string bytes;
};

/// Reads a whole file. Throws an InputError with the system's reason if that fails, and for
/// folders, pipes and devices.
FileBytes load_file(const std::filesystem::path& path);

/// Position in a file: a line, or a byte of a binary file.
struct Place {
  std::int64_t line = 0;   ///< line, from 1; 0: none
  std::int64_t byte = -1;  ///< byte, from 0; -1: none
};

/// Returns "on line 3", "at byte 120", or an empty text for no place.
std::string to_text(const Place& place);

/// Throws an InputError "FILE:LINE: MESSAGE", or "FILE: byte N: MESSAGE".
[[noreturn]] void refuse(const std::string& file, const Place& place, const std::string& message);

/// Returns input for an error message: in quotes, without control characters, cut if it is long.
std::string shown(std::string_view input);

/// Returns the extension of a file without its dot, in lower case.
std::string extension_of(const std::filesystem::path& path);

/// Returns the format that the extension of a file names. Throws an InputError with the choices if
/// there is none.
/// @param formats  list of formats with a member `extension`
/// @param kind     kind of file for the message
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

/// Compression method of VTK for blocks of arrays.
struct Compressor {
  const char* name;           ///< name in VTK's files
  std::size_t largest_ratio;  ///< maximum possible ratio of decompressed to compressed size
  /// Returns the decompressed block; nothing if it does not have `size` bytes or is broken.
  std::optional<std::string> (*decompress)(std::string_view block, std::size_t size);
};

/// Returns the compressor of that name; null for none.
const Compressor* find_compressor(std::string_view name);

/// Returns the names of all compressors, as "A and B".
std::string compressor_names();

}  // namespace plica
