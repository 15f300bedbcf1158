// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>

namespace plica::app {

/// A file or folder that cannot be read or written; what() names it and the reason.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Replaces the file as a whole: readers, and whoever finds it after a killed run, see the old content or the new.
void write_file(const std::filesystem::path& file, const std::string& content);

/// Makes the folder, and those above it, where they are missing.
void make_folder(const std::filesystem::path& folder);

}  // namespace plica::app
