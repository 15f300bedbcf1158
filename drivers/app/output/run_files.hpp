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

/// State of the tetrahedra of one level at one time.
struct VolumeSnapshot {
  int level = 0;                             ///< number of the level; 0: the finest
  std::vector<Point> positions, velocities;  ///< state of the vertices [m, m/s]
  ElementFields elements;
};

/// State of a run at one time, on the host, in the order of the scene's meshes.
struct Snapshot {
  double time = 0;                           ///< simulated time [s]
  std::vector<Point> positions, velocities;  ///< state of level 0's vertices [m, m/s]
  /// state of the embedded surface's points; empty: there is none [m, m/s]
  std::vector<Point> surface, surface_velocities;
  std::vector<VolumeSnapshot> volumes;  ///< state of the levels that are written
  Energies energies;
  std::vector<Wrench> wrenches;       ///< forces and torques over the last macro step
  std::vector<ToolState> tools;       ///< poses of obstacles with mass
  std::vector<HeldBy> held;           ///< grasped points of each obstacle that can grasp
  std::vector<CavityState> cavities;  ///< volume and pressure of each cavity
  int torn = 0;                       ///< number of attached points that are torn
  long step_halvings = 0;             ///< halvings of macro steps so far
  double friction_work = 0;           ///< work of friction so far [J]
  std::vector<double> slipping;       ///< part of the contacts of each obstacle that slips
  /// pressure of contact at the embedded surface's points [Pa]; empty: not asked for, or no contact
  std::vector<double> contact_pressure = {};
  std::vector<Reaction> reactions = {};  ///< forces and torques that hold vertices
};

/// Returns how often macro steps were halved so far; 0 if steps that fail are not halved.
template <class B>
long halvings_of(const Simulation<B>& simulation) {
  const auto counters = simulation.counters();
  const auto found = counters.find("step_halvings");
  return found == counters.end() ? 0 : found->second;
}

/// Returns true if an obstacle or the contact between bodies has friction.
bool has_friction(const ContactOptions& contact);

/// Returns the present state of a simulation, with the levels that `volumes` names and the fields
/// that `output` asks for.
template <class B>
Snapshot take_snapshot(const Simulation<B>& simulation, double time,
                       const std::vector<int>& volumes, const OutputOptions& output) {
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
                                simulation.element_fields(level, output.writes_tensors())});
  if (output.writes(contact_pressure_field))
    snapshot.contact_pressure = simulation.contact_pressure();
  snapshot.reactions = simulation.reactions();
  return snapshot;
}

/// Returns the names of the obstacles that have closed by their `grasp` and grasped no point. An
/// obstacle counts when it has been closed for more than one macro step [s].
std::vector<std::string> empty_handed(const ContactOptions& contact, const Snapshot& now,
                                      double macro_step);

/// Returns the mass at each vertex of a level [kg]: a quarter of every tetrahedron around it.
std::vector<double> vertex_masses(const Body& body, int level = 0);

/// Writer of history.csv: one row per output time. The columns are
///   - energies, centre of mass and speeds of level 0
///   - force and torque of each of wrench_names(), over the macro step that ends at this time
///   - displacement and velocity of obstacles with mass; with inertia, how they turn, too
///   - number of grasped points of each obstacle that can grasp
///   - volume and pressure of cavities
///   - number of step halvings so far, if macro steps that fail are halved
///   - work of friction so far, and for each obstacle with friction the part of its contacts that
///     slips
///   - number of attached points that are torn
///   - force and torque of each of held_names(), at this time
class History {
 public:
  /// Starts the file, or continues it after its first `kept` bytes.
  /// @param masses  mass at each vertex of level 0 [kg]
  History(const std::filesystem::path& file, std::vector<double> masses, const Problem& problem,
          std::optional<std::uint64_t> kept = {});
  void write(const Snapshot& snapshot);
  /// Sets the masses of a body that was cut [kg].
  void set_masses(std::vector<double> masses) { masses_ = std::move(masses); }
  GrowingFile& file() { return file_; }
  const GrowingFile& file() const { return file_; }

 private:
  GrowingFile file_;
  std::vector<double> masses_;
  bool tears_, halves_, rubs_;
  std::vector<std::size_t> rubbing_;  // numbers of the obstacles with friction
};

/// Returns the names of the files of a run that are in a folder, the checkpoint first. Empty: the
/// folder holds no run.
std::vector<std::string> former_run(const std::filesystem::path& folder);

/// Sizes of a run's files, as a checkpoint stores them.
struct FilesMark {
  std::vector<double> frame_times;  ///< times of the frames [s]
  std::uint64_t history_bytes = 0, probe_bytes = 0;
};

/// Writer of the frames and the history of a run, in the run's folder.
class RunFiles {
 public:
  /// Removes the files of a former run in the folder. With `from`, cuts them back to that mark of a
  /// checkpoint instead.
  RunFiles(const Scene& scene, const std::filesystem::path& folder,
           const std::optional<FilesMark>& from = {});
  /// Writes a frame of the surface, one of each level of volumes(), and a row of the history.
  void write(const Snapshot& snapshot);
  /// Takes over the mesh and the surface of a body that has been cut since the last call, or whose
  /// part has moved. To be called before a snapshot of it is written.
  template <class B>
  void follow_mesh(const Simulation<B>& simulation) {
    if (simulation.mesh_changes() == mesh_changes_) return;
    mesh_changes_ = simulation.mesh_changes();
    if (body_.following)
      take_mesh(simulation.mesh());
    else
      take_cut(simulation.mesh(), simulation.surface(), simulation.surface_vertices());
  }
  const std::vector<int>& volumes() const { return volume_levels_; }  ///< levels that are written
  const OutputOptions& output() const { return output_; }
  std::size_t frames() const { return frame_times_.size(); }
  /// Returns the time of the last frame on disk [s].
  double last_time() const { return frame_times_.empty() ? 0 : frame_times_.back(); }
  FilesMark mark() const { return {frame_times_, history_.file().size(), 0}; }
  std::uint64_t history_bytes() const { return history_.file().size(); }
  /// Keeps the first `frames` frames and `history_bytes` of the history, and removes the rest.
  void cut_back(std::size_t frames, std::uint64_t history_bytes);
  /// Waits until all files are on disk.
  void sync();

 private:
  struct Volume {  // constant data of a level that is written, in input order
    TetMesh mesh;
    std::vector<double> mass;
  };
  void take_cut(const TetMesh& mesh, const std::optional<TriangleSurface>& surface,
                const std::vector<int>& surface_vertices);
  void take_mesh(const TetMesh& mesh);
  VtuGrid surface_grid(const Snapshot& snapshot) const;
  VtuGrid volume_grid(const VolumeSnapshot& volume, const Volume& constant, double time) const;

  Body body_;                         // the body, with the regions that the scene selects
  std::vector<Numbering> numbering_;  // numbering of each level
  const OutputOptions& output_;
  Point placement_;
  TriangleSurface skin_;          // the embedded surface, or the boundary of level 0, at rest
  std::vector<int> skin_vertex_;  // numbers in level 0 of the boundary's vertices
  std::vector<int> skin_body_;    // body of each triangle; empty: one body
  std::vector<int> volume_levels_;
  std::vector<Volume> volumes_;
  long mesh_changes_ = 0;  // number of changes of the mesh that were taken over
  std::vector<double> frame_times_;
  Frames surface_frames_;
  std::vector<Frames> volume_frames_;
  History history_;
};

/// Returns the names of the probes, in alphabetical order.
std::vector<std::string> names_of(const std::map<std::string, Point>& probes);
/// Returns the points of the probes at rest [m], in alphabetical order of their names.
std::vector<Point> points_of(const std::map<std::string, Point>& probes);

/// Returns the head of probes.csv: "time,tip_x,tip_y,tip_z,tip_vx,tip_vy,tip_vz".
std::string probe_head(const std::vector<std::string>& names);
/// Returns a row of probes.csv: time [s], positions [m] and velocities [m/s] of the probes.
std::string probe_row(double time, const std::vector<Point>& positions,
                      const std::vector<Point>& velocities);

}  // namespace plica::app
