// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/files/writing.hpp>
#include <string>
#include <vector>

/// Functions that the commands that write meshes share.
namespace plica::app {

/// Prints one warning about the file for each sentence.
void warn(const std::filesystem::path& file, const std::vector<std::string>& warnings);

/// Writes the files, warns about what their format leaves out, and prints their sizes.
void write(const std::filesystem::path& out, const WrittenMesh& written);

}  // namespace plica::app
