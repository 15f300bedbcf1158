// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <map>
#include <plica/drivers/app/commands/arguments.hpp>
#include <plica/drivers/app/commands/exit_status.hpp>
#include <string>

namespace plica::app {

struct MeshInfoArguments {
  std::filesystem::path file;
  bool json = false;
  std::string scale = "1";                      ///< metres per unit of the file, as text
  std::map<std::string, std::string> material;  ///< keys of a scene's body.material, as text; the rest has its defaults
  KokkosArguments kokkos;
};

/// plica mesh info: what a mesh or surface file holds, what was mended in it, how well its tetrahedra are shaped, and which
/// explicit step they allow.
ExitStatus mesh_info(const MeshInfoArguments& arguments);

}  // namespace plica::app
