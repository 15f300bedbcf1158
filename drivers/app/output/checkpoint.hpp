// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>

namespace plica::app {

/// A run at one point, from which it can go on.
struct Checkpoint {
  std::string scene_file;    ///< as it was given
  std::string scene_path;    ///< the same from the root: its mesh files are found beside it
  Tree scene;                ///< with what the command line changed
  std::uint64_t meshes = 0;  ///< their digest
  std::string precision, backend, program;
  Interval every, frame_every;

  long macro_steps = 0;
  double wall_time = 0;                  ///< so far [s]
  std::map<std::string, double> stages;  ///< so far [s]
  std::optional<CycleChoice> choice;     ///< of cycle auto
  FilesMark files;
  /// of EnergyBudget; then the work of obstacles [J], and 1 where that is known
  std::vector<double> energy;
  std::vector<double> inside_out;  ///< of InsideOut
  std::vector<double> depth;       ///< of ContactDepth
  SavedState state;
};

/// Of all levels' meshes and the surface, as the simulation gets them.
std::uint64_t mesh_digest(const Body& body);

/// FOLDER/checkpoint.bin: a line with the format's version, one with the sizes and the digest of
/// what follows, then that: all but the state as JSON, and the state's bytes. Written as a whole,
/// and on the disk when this returns: whoever looks finds the last one or this one.
void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// InputError for a folder without one, one that is damaged, or of another version.
Checkpoint read_checkpoint(const std::filesystem::path& folder);

}  // namespace plica::app
