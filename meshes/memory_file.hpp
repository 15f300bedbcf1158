// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <filesystem>
#include <plica/core/error.hpp>
#include <string>
#include <string_view>

namespace plica {

/// A file in memory.
struct MemoryFile {
  std::string name;  ///< as errors show it; its extension tells the format
  std::string bytes;
};

/// Reads all of it; InputError when there is none, or a folder.
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

}  // namespace plica
