// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/drivers/app/commands/exit_status.hpp>

namespace plica::app {

/// plica mesh info: what a mesh file holds, what was mended in it, and how well its tetrahedra are shaped.
ExitStatus mesh_info(const std::filesystem::path& file, bool json);

}  // namespace plica::app
