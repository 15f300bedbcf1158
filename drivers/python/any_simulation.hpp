// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/app/view/live_view.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <string>
#include <vector>

/// Simulation as Python sees it, with one type for both precisions. Arrays are on the host in
/// double, with rows in the order of the mesh files.
namespace plica::python {

/// Table of numbers, row after row.
using Values = std::vector<double>;

/// Fields that follow the simulation as live arrays, [rows][3].
enum class Field { positions, velocities, surface_positions, surface_velocities, surface_normals };

/// Function that adds to `forces` [N], from positions [m] and velocities [m/s] at a time [s]. All
/// three arrays are [vertices][3].
using HostForces = std::function<void(int level, double time, const Values& positions,
                                      const Values& velocities, Values& forces)>;

/// Place of an obstacle by its motion: see Simulation::obstacle_displacement() and so on.
struct ObstaclePlace {
  std::string name;
  Point displacement = Point::Zero();  ///< from the place in its shape's options [m]
  Point rotation = Point::Zero();      ///< rotation vector [rad]
  Point origin = Point::Zero();        ///< point that torques are about, where it is now [m]
};

/// Interface of a simulation in either precision. What changes it throws std::runtime_error within
/// a step of it, where a caller's forces are asked for.
class AnySimulation {
 public:
  virtual ~AnySimulation() = default;

  /// Takes checked macro steps until this time [s], at most `at_most`. Calls between() after each
  /// step. Returns a diagnosis if a step failed. After a diagnosis, or an exception within a step,
  /// the state is the last good one; with set_forces(), after an exception it is that before the
  /// step.
  virtual std::optional<Diagnosis> advance(double until, long at_most,
                                           const std::function<void()>& between) = 0;
  /// Shortens the macro step that would go beyond this time [s], see Simulation::end_at().
  virtual void end_at(double time) = 0;

  /// Returns the values of a field. They follow the simulation as long as a caller keeps them.
  std::shared_ptr<Values> live(Field field, int level);
  /// Returns fields of a level's elements, in input order. See Simulation::element_fields().
  virtual ElementFields element_fields(int level, bool tensors) const = 0;
  virtual std::vector<double> contact_pressure() const = 0;  ///< see Simulation::contact_pressure()
  virtual std::vector<Wrench> wrenches() const = 0;          ///< see Simulation::wrenches()
  virtual std::vector<Reaction> reactions() const = 0;       ///< see Simulation::reactions()
  virtual std::vector<double> contact_depths() const = 0;    ///< see Simulation::contact_depths()
  virtual std::vector<ToolState> tools() const = 0;          ///< see Simulation::tools()
  virtual std::vector<HeldBy> held() const = 0;              ///< see Simulation::held()
  virtual void grasp(int obstacle) = 0;                      ///< see Simulation::grasp()
  virtual void release(int obstacle) = 0;                    ///< see Simulation::release()
  virtual std::vector<CavityState> cavities() const = 0;     ///< see Simulation::cavities()
  /// Moves an obstacle to a displacement [m] and a rotation vector [rad], if one is given. See
  /// Simulation::move_obstacle().
  virtual void move_obstacle(int obstacle, const Point& displacement,
                             const std::optional<Point>& rotation) = 0;
  /// Sets how an obstacle moves and turns from now on. See Simulation::set_obstacle_motion() and
  /// set_obstacle_turn().
  virtual void set_obstacle_motion(int obstacle, const std::optional<Motion>& motion,
                                   const std::optional<Turn>& turn) = 0;
  /// Returns for each obstacle where its motion has it.
  virtual std::vector<ObstaclePlace> obstacles() const = 0;
  /// Cuts the body, see Simulation::cut(). Arrays from before the cut stay as they are.
  virtual CutReport cut(const Blade& blade) = 0;
  virtual void set_gravity(const Point& gravity) = 0;  ///< see Simulation::set_gravity()
  virtual void set_time(double time) = 0;              ///< see Simulation::set_time()

  virtual double time() const = 0;                           ///< simulated time [s]
  virtual double macro_step() const = 0;                     ///< length of a macro step [s]
  virtual long macro_steps() const = 0;                      ///< number of macro steps so far
  virtual Energies energies() const = 0;                     ///< energies of level 0 [J]
  virtual std::vector<LevelReport> levels() const = 0;       ///< elements numbered as in the files
  virtual std::map<std::string, long> counters() const = 0;  ///< see Simulation::counters()
  virtual double residual() const = 0;                       ///< see Simulation::residual()
  virtual std::string precision() const = 0;                 ///< float | double

  /// Replaces level 0's positions [m] and velocities [m/s], both [vertices][3].
  virtual void set_state(const Values& positions, const Values& velocities) = 0;
  /// Sets a function that adds forces on every level; an empty one ends that. Throws InputError if
  /// the back end is not on the host.
  virtual void set_forces(HostForces forces) = 0;
  virtual SavedState save() const = 0;                ///< see Simulation::save()
  virtual void restore(const SavedState& saved) = 0;  ///< see Simulation::restore()
  /// Goes back to the start. The first call, where something has changed before, sets the scene up
  /// once more to know it.
  virtual void reset() = 0;

  /// Starts the files of a run in this folder: frames and history.csv, as `plica run` writes them.
  virtual void start_files(const std::filesystem::path& folder) = 0;
  /// Writes the state as a frame, and summary.json with the status of the run: running, completed
  /// or diverged.
  virtual void write_frame(const std::string& status,
                           const std::optional<Diagnosis>& diagnosis) = 0;

  /// Serves a live view of the simulation, see app::show_live(). Sets `options.method`.
  virtual void show_live(app::LiveOptions options) = 0;

 protected:
  /// Copies a field of a level to `to`, in input order.
  virtual void read(Field field, int level, Values& to) const = 0;
  /// Updates all live arrays to the present state.
  void refresh();
  /// Leaves all live arrays as they are from now on: the body has other sizes.
  void leave_live() { lives_.clear(); }

 private:
  struct Live {
    Field field;
    int level;
    std::weak_ptr<Values> values;
  };
  std::vector<Live> lives_;
};

/// Starts Kokkos and sets a scene up; precision: float or double. Throws InputError with the
/// location in the scene.
std::unique_ptr<AnySimulation> make_simulation(std::shared_ptr<const app::Scene> scene,
                                               const std::string& precision);

}  // namespace plica::python
