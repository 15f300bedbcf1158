// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// Writes a mesh in the format that the extension of the file names; coordinates keep every bit. TetGen's format is two
/// files, whichever of them is named.
/// @param format  the name of a format of that extension (see list.hpp); empty: the first one
/// @return        what the format cannot hold, a sentence each
/// @throw InputError for an unknown extension or format, and when a file cannot be written
std::vector<std::string> write_mesh(const std::filesystem::path& path, const TetMesh& mesh,
                                    const std::string& format = "");

}  // namespace plica
