// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/meshes/files/read_options.hpp>
#include <plica/meshes/files/writing.hpp>
#include <string>
#include <utility>
#include <vector>

/// Functions that the commands that write meshes share.
namespace plica::app {

/// Returns the choices of a command line for a file. Throws InputError for other values.
ReadOptions read_options_of(const ReadArguments& arguments, Flaws flaws = Flaws::refused);

/// Returns the names or numbers between the commas of --leave-out.
std::vector<std::string> left_out_by(const ReadArguments& arguments);

/// Throws InputError where one of these options is given, as the file holds something else.
void refuse_options(const std::vector<std::pair<std::string, std::string>>& given,
                    const std::string& why, const std::filesystem::path& file);

/// Prints one warning about the file for each sentence.
void warn(const std::filesystem::path& file, const std::vector<std::string>& warnings);

/// Writes the files, warns about what their format leaves out, and prints their sizes.
void write(const std::filesystem::path& out, const WrittenMesh& written);

}  // namespace plica::app
