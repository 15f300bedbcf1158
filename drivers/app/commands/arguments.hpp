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
  std::string precision;  ///< float or double; empty: double, or a checkpoint's
  bool json = false;
  KokkosArguments kokkos;
};

struct RunArguments : SceneArguments {
  std::filesystem::path folder;  ///< empty: out/SCENE
  std::filesystem::path resume;  ///< the folder of the run to go on with; empty: a new run
  std::string checkpoint;        ///< "every=100", "every=0.1s"; empty: none, or as the run to go on with
  bool quiet = false;
  bool time_stages = false;        ///< also where that slows the run
  std::vector<std::string> words;  ///< the command line as it was given
};

struct StudyArguments {
  std::string budget;   ///< wall time, "60s"; empty: as long as it takes
  bool space = false;   ///< a second reference on a finer mesh
  bool growth = false;  ///< of the linearised cycles too
};

struct StabilityArguments {
  std::string budget;   ///< as of a study
  bool matrix = false;  ///< of stiff and extreme cases, instead of a scene
};

struct VerifyArguments {
  std::vector<std::string> problems;  ///< empty: all
  bool small = false;
};

}  // namespace plica::app
