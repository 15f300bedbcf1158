// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>

namespace plica::app {

/// State of a run at one time, from which the run can be resumed.
struct Checkpoint {
  std::string scene_file;    ///< path of the scene as the user gave it
  std::string scene_path;    ///< absolute path of the scene; names of mesh files are relative to it
  Tree scene;                ///< the scene, with the changes of the command line
  std::uint64_t meshes = 0;  ///< see mesh_digest()
  std::string precision, backend, program;
  Interval every, frame_every;

  long macro_steps = 0;
  double wall_time = 0;                  ///< wall time of the run so far [s]
  std::map<std::string, double> stages;  ///< wall time of each stage so far [s]
  std::optional<CycleChoice> choice;     ///< choice of cycle auto; none: another cycle
  FilesMark files;
  /// values of EnergyBudget, then the work of obstacles [J], then 1 if that work is known, else 0
  std::vector<double> energy;
  std::vector<double> inside_out;  ///< values of InsideOut::save()
  std::vector<double> depth;       ///< values of ContactDepth::save()
  SavedState state;
};

/// Returns a digest of the meshes of all levels and of the embedded surface.
std::uint64_t mesh_digest(const Body& body);

/// Writes FOLDER/checkpoint.bin. Its first line has the format's version, its second line the sizes
/// and the digest of the rest. The rest is everything but the state, as JSON, then the state's
/// bytes. The file is replaced as a whole, and is on disk when this returns: a reader finds either
/// the last checkpoint or this one.
void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// Reads FOLDER/checkpoint.bin. Throws InputError if there is none, or if it is damaged or of
/// another version.
Checkpoint read_checkpoint(const std::filesystem::path& folder);

}  // namespace plica::app
