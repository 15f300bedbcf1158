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

/// A scene in motion as Python sees it: in either precision behind one type, arrays on the host in
/// double, rows in the order of the meshes' files.
namespace plica::python {

/// Numbers row after row.
using Values = std::vector<double>;

/// What can be looked at while it changes, [rows][3].
enum class Field { positions, velocities, surface_positions, surface_velocities };

/// Adds to `forces` [N]; all three are [vertices][3].
using HostForces = std::function<void(int level, double time, const Values& positions,
                                      const Values& velocities, Values& forces)>;

class AnySimulation {
 public:
  virtual ~AnySimulation() = default;

  /// Checked macro steps until this time, at most so many. Calls between() after each. A diagnosis:
  /// the state is the last good one. Where something throws within a step, too.
  virtual std::optional<Diagnosis> advance(double until, long at_most,
                                           const std::function<void()>& between) = 0;
  /// See Simulation::end_at().
  virtual void end_at(double time) = 0;

  /// The values of a field, which follow the simulation as long as somebody holds them.
  std::shared_ptr<Values> live(Field field, int level);
  virtual ElementFields element_fields(int level) const = 0;
  virtual std::vector<Wrench> wrenches() const = 0;
  virtual std::vector<double> contact_depths() const = 0;
  virtual std::vector<ToolState> tools() const = 0;
  virtual std::vector<HeldBy> held() const = 0;
  /// See Simulation::grasp() and release().
  virtual void grasp(int obstacle) = 0;
  virtual void release(int obstacle) = 0;
  virtual std::vector<CavityState> cavities() const = 0;
  /// See Simulation::move_obstacle().
  virtual void move_obstacle(int obstacle, const Point& displacement,
                             const std::optional<Point>& rotation) = 0;

  virtual double time() const = 0;
  virtual double macro_step() const = 0;
  virtual long macro_steps() const = 0;
  virtual Energies energies() const = 0;
  virtual std::vector<LevelReport> levels() const = 0;
  virtual std::map<std::string, long> counters() const = 0;
  virtual std::string precision() const = 0;

  virtual void set_state(const Values& positions, const Values& velocities) = 0;
  virtual void set_forces(HostForces forces) = 0;
  virtual SavedState save() const = 0;
  virtual void restore(const SavedState& saved) = 0;

  /// From now on the files of a run in this folder, as those of `plica run`.
  virtual void start_files(const std::filesystem::path& folder) = 0;
  /// Writes the state as a frame, and the summary, with what a run is like so far: running,
  /// completed, diverged.
  virtual void write_frame(const std::string& status,
                           const std::optional<Diagnosis>& diagnosis) = 0;

  /// See app::show_live(); the method is filled in.
  virtual void show_live(app::LiveOptions options) = 0;

 protected:
  virtual void read(Field field, int level, Values& to) const = 0;
  /// What is held shows the state there is now.
  void refresh();

 private:
  struct Live {
    Field field;
    int level;
    std::weak_ptr<Values> values;
  };
  std::vector<Live> lives_;
};

/// Sets the scene up; precision: float or double. InputError with the place in the scene. Starts
/// Kokkos.
std::unique_ptr<AnySimulation> make_simulation(std::shared_ptr<const app::Scene> scene,
                                               const std::string& precision);

}  // namespace plica::python
