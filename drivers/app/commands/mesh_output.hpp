// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/files/writing.hpp>
#include <string>
#include <vector>

/// What the commands that write meshes have in common.
namespace plica::app {

/// A warning about a file for each sentence.
void warn(const std::filesystem::path& file, const std::vector<std::string>& warnings);

/// Writes the files, warns of what they leave out, and says how large they are.
void write(const std::filesystem::path& out, const WrittenMesh& written);

}  // namespace plica::app
