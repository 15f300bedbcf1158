// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <optional>
#include <plica/drivers/app/commands/exit_status.hpp>
#include <string>

namespace plica::app {

struct ConvertArguments {
  std::filesystem::path in, out;
  std::string format;  ///< of those the extension has; empty: the first
  bool binary = false;
  std::string scale = "1";                      ///< metres per unit of the file, as text
  std::optional<std::string> merge_duplicates;  ///< a length, as text
};

/// plica mesh convert: writes a mesh or surface in another format. The file OUT may be IN, and is replaced as a whole.
ExitStatus mesh_convert(const ConvertArguments& arguments);

/// The formats that are written, a line each.
std::string written_formats_text();

}  // namespace plica::app
