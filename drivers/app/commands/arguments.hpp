// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// What the command line says about Kokkos.
struct KokkosArguments {
  int threads = 0;                        ///< 0: as Kokkos finds
  std::vector<std::string> pass_through;  ///< --kokkos-*
};

/// What every command that takes a scene knows.
struct SceneArguments {
  std::filesystem::path scene;
  std::vector<Override> overrides;
  std::string precision = "double";
  bool json = false;
  KokkosArguments kokkos;
};

struct RunArguments : SceneArguments {
  std::filesystem::path folder;  ///< empty: out/SCENE
  bool quiet = false;
  bool time_stages = false;        ///< also where that slows the run
  std::vector<std::string> words;  ///< the command line as it was given
};

}  // namespace plica::app
