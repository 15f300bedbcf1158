// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <plica/drivers/app/output/frames.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// The tetrahedra of one level at one point in time.
struct VolumeSnapshot {
  int level = 0;
  std::vector<Point> positions, velocities;  ///< [m, m/s]
  ElementFields elements;
};

/// The state of a run at one point in time, on the host, numbered as the scene's meshes are.
struct Snapshot {
  double time = 0;                                 ///< [s]
  std::vector<Point> positions, velocities;        ///< of level 0's vertices [m, m/s]
  std::vector<Point> surface, surface_velocities;  ///< of the embedded surface's; empty without one
  std::vector<VolumeSnapshot> volumes;             ///< of the levels that are written
  Energies energies;
  std::vector<Wrench> wrenches;  ///< of the obstacles, of the macro step that ends here
  std::vector<ToolState> tools;  ///< obstacles with mass
  std::vector<HeldBy> held;      ///< by obstacles that can hold points
  std::vector<CavityState> cavities;
  int torn = 0;                  ///< attached points
  long step_halvings = 0;        ///< of macro steps so far
  double friction_work = 0;      ///< so far [J]
  std::vector<double> slipping;  ///< of what touches each obstacle, the part that slips
};

/// Of macro steps so far; 0 where those that fail are not halved.
template <class B>
long halvings_of(const Simulation<B>& simulation) {
  const auto counters = simulation.counters();
  const auto found = counters.find("step_halvings");
  return found == counters.end() ? 0 : found->second;
}

/// Whether something rubs: an obstacle, or bodies.
bool has_friction(const ContactOptions& contact);

template <class B>
Snapshot take_snapshot(const Simulation<B>& simulation, double time,
                       const std::vector<int>& volumes) {
  Snapshot snapshot{time,
                    simulation.positions(),
                    simulation.velocities(),
                    simulation.surface_positions(),
                    simulation.surface_velocities(),
                    {},
                    simulation.energies(),
                    simulation.wrenches(),
                    simulation.tools(),
                    simulation.held(),
                    simulation.cavities(),
                    simulation.torn_attachments(),
                    halvings_of(simulation),
                    simulation.friction_work(),
                    simulation.slipping()};
  for (const int level : volumes)
    snapshot.volumes.push_back({level, simulation.positions(level), simulation.velocities(level),
                                simulation.element_fields(level)});
  return snapshot;
}

/// The obstacles that closed by their `grasp`, at least a macro step [s] ago, and hold nothing.
std::vector<std::string> empty_handed(const ContactOptions& contact, const Snapshot& now,
                                      double macro_step);

/// Mass at each vertex of a level: a quarter of every tetrahedron around it. [kg]
std::vector<double> vertex_masses(const Body& body, int level = 0);

/// history.csv: energies, centre of mass and speeds of level 0, a row per output time; where bad
/// macro steps are retried, how often one was halved so far; what each of wrench_names() does or
/// feels, over the macro step that ends there; where obstacles with mass are; how many points those
/// hold that can; volume and pressure in cavities; how often implicit steps were halved so far;
/// with friction its work so far, and of each obstacle that rubs the part of what touches it that
/// slips; how many attached points are torn.
class History {
 public:
  /// Starts the file, or goes on after its first `kept` bytes.
  History(const std::filesystem::path& file, std::vector<double> masses, const Problem& problem,
          std::optional<std::uint64_t> kept = {});
  void write(const Snapshot& snapshot);
  GrowingFile& file() { return file_; }
  const GrowingFile& file() const { return file_; }

 private:
  GrowingFile file_;
  std::vector<double> masses_;
  bool tears_, halves_, rubs_;
  std::vector<std::size_t> rubbing_;  // obstacles with friction
};

/// Which of the files that tell of a run are in a folder, its checkpoint first; none: it holds no
/// run.
std::vector<std::string> former_run(const std::filesystem::path& folder);

/// How far a run's files are: what a checkpoint remembers of them.
struct FilesMark {
  std::vector<double> frame_times;  ///< [s]
  std::uint64_t history_bytes = 0, probe_bytes = 0;
};

/// What a run leaves in its folder while it goes on: frames and history. A former run's files there
/// give way, or are cut back to the mark of the checkpoint from which this run goes on.
class RunFiles {
 public:
  RunFiles(const Scene& scene, const std::filesystem::path& folder,
           const std::optional<FilesMark>& from = {});
  /// Writes the volumes that volumes() names, and all else.
  void write(const Snapshot& snapshot);
  const std::vector<int>& volumes() const { return volume_levels_; }
  std::size_t frames() const { return frame_times_.size(); }
  /// of what is on disk [s]
  double last_time() const { return frame_times_.empty() ? 0 : frame_times_.back(); }
  FilesMark mark() const { return {frame_times_, history_.file().size(), 0}; }
  std::uint64_t history_bytes() const { return history_.file().size(); }
  /// To the first so many frames, and so much of the history: what comes next replaces the rest.
  void cut_back(std::size_t frames, std::uint64_t history_bytes);
  /// Waits until all of it is on the disk.
  void sync();

 private:
  struct Volume {  // a written level: what stays the same, in input order
    TetMesh mesh;
    std::vector<double> mass;
  };
  VtuGrid surface_grid(const Snapshot& snapshot) const;
  VtuGrid volume_grid(const VolumeSnapshot& volume, const Volume& constant, double time) const;

  Body body_;                                // with the regions that are selected
  const std::vector<Numbering>& numbering_;  // of its levels
  Point placement_;
  TriangleSurface skin_;          // the embedded surface, else the boundary of level 0, at rest
  std::vector<int> skin_vertex_;  // of that boundary: its vertices' numbers in level 0
  std::vector<int> skin_body_;    // of its triangles the body, where there are several
  std::vector<int> volume_levels_;
  std::vector<Volume> volumes_;
  std::vector<double> frame_times_;
  Frames surface_frames_;
  std::vector<Frames> volume_frames_;
  History history_;
};

std::vector<std::string> names_of(const std::map<std::string, Point>& probes);
std::vector<Point> points_of(const std::map<std::string, Point>& probes);

/// "time,tip_x,tip_y,tip_z,tip_vx,tip_vy,tip_vz" and a row of it.
std::string probe_head(const std::vector<std::string>& names);
std::string probe_row(double time, const std::vector<Point>& positions,
                      const std::vector<Point>& velocities);

}  // namespace plica::app
