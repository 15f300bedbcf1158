// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <plica/core/backend.hpp>
#include <plica/core/device_array.hpp>
#include <plica/core/problem.hpp>
#include <plica/core/reports.hpp>
#include <plica/drivers/loads/external_forces.hpp>
#include <string>
#include <vector>

namespace plica {

/// A deformable body, meshed at one or several resolutions, in motion. Not copyable; one object
/// must not be used by two threads at a time. Kokkos must be initialised before and finalised after
/// its life.
template <class B>
class Simulation {
 public:
  using Exec = typename B::Exec;  ///< the execution space it runs on

  /// Sets everything up. Throws InputError with the values, the choices and the remedy.
  explicit Simulation(const Problem& problem, const Exec& exec = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// One macro step. Enqueues work; does not wait for it (implicit levels read their residuals on
  /// the way).
  void step();

  /// Why the run must stop, if it must: non-finite values, inverted elements where they are not
  /// allowed, more kinetic energy than was put in, a vertex that leaves the body by more than its
  /// edge in one explicit sub-step, a surface point deeper in an obstacle than the body is large, a
  /// solver that gave up, a stepper that has lost its stability. Waits. Examines the state there
  /// is: with integration.on_failure.halvings also level 0's elements (one or two passes more).
  /// Cheap enough to be called after every macro step; states that pass are kept from time to time.
  /// After one that passes, sub-steps that recover() has cut may be given back: every hundred macro
  /// steps at most it looks whether longer ones are stable, which takes as long as some ten steps.
  std::optional<Diagnosis> check();

  /// Repairs a state that did not pass check(), where that is possible: goes back to the last state
  /// that was kept and steps again to the same time, with the inertia fitted again (cycle him), or
  /// in halved steps (integration.on_failure). External forces are asked for again. Returns the
  /// diagnosis of a state that is still bad, which stays as it is; none: the run goes on.
  std::optional<Diagnosis> recover(const Diagnosis& bad);

  /// step(), check() and, where that finds something, recover(): one macro step of a run. Waits.
  std::optional<Diagnosis> step_checked();

  /// From now on a macro step that would go beyond this time [s] ends there. It is shorter than the
  /// others and not counted among macro_steps(); the step after it makes up the rest.
  void end_at(double time);

  /// Calls this after each macro step that recover() takes again, in their order; where a try
  /// fails, from an earlier one on again. For drivers that record motion: macro_steps() and time()
  /// say from where on it is replaced.
  void on_repeated_step(std::function<void()> call);
  /// The macro step whose end is the earliest state that recover() may go back to.
  long earliest_kept() const;

  /// Takes all levels and the time back to the last state that was kept.
  void return_to_last_good();

  double time() const;                             ///< simulated [s]
  double macro_step() const;                       ///< [s]
  long macro_steps() const;                        ///< done
  const std::vector<LevelReport>& levels() const;  ///< finest first; only those the cycle uses
  std::optional<HimReport> him() const;            ///< of that cycle
  std::vector<Part> parts() const;                 ///< what it is made of, in and out
  Energies energies() const;                       ///< waits
  /// Of obstacles, then bodies, of the last macro step; after a step that end_at() made shorter, of
  /// the one before. Waits.
  std::vector<Wrench> wrenches() const;
  /// How deep the surface is in each obstacle at its deepest place [m]; 0 outside. Points that it
  /// holds are left out. Waits.
  std::vector<double> contact_depths() const;
  /// Likewise in other bodies, or in itself where it folds, at the deepest place of all [m]. Waits.
  double pair_depth() const;
  /// What friction has done so far, on the body and on what rubs it [J]: below 0 it is lost, or
  /// stored where the body sticks. Waits.
  double friction_work() const;
  /// Of each obstacle the part of what touches it that slips: whose friction is at its cap. Waits.
  std::vector<double> slipping() const;
  std::vector<ToolState> tools() const;       ///< of obstacles with mass; waits
  std::vector<HeldBy> held() const;           ///< of obstacles that can hold points; waits
  int torn_attachments() const;               ///< points whose attachments are torn; waits
  std::vector<CavityState> cavities() const;  ///< whose volume is given, of level 0; waits
  /// The wrenches as the device holds them, force and torque of one after the other, 6 numbers
  /// each; step() updates it in place.
  Doubles<B> wrench() const;
  std::map<std::string, double> stages()
      const;  ///< stage name -> wall time so far [s]; empty unless timing was asked for
  std::map<std::string, long> counters()
      const;  ///< force evaluations, solver iterations, misses, switched vertices ...
  /// The largest part of its forces that an implicit stage of the last macro step left unbalanced;
  /// of a linearly implicit one, the relative residual of its linear solve.
  double residual() const;
  double worst_residual() const;  ///< of all macro steps so far

  /// A level's displacements from the placed rest mesh [m] as the device holds them, [vertices][3].
  /// step() updates them in place; the view may outlive the simulation.
  Vectors<B> displacement(int level = 0) const;
  /// Likewise its velocities [m/s].
  Vectors<B> velocity(int level = 0) const;

  /// A level's positions [m] after the steps enqueued so far, in input order, into a view of the
  /// caller's on the device: [vertices][3], float or double, in any layout. Enqueues, does not
  /// wait; a level's first call uploads its rest positions. Throws InputError where the sizes
  /// differ.
  void read_positions(const DeviceOutput<B>& to, int level = 0) const;
  /// Likewise its velocities [m/s].
  void read_velocities(const DeviceOutput<B>& to, int level = 0) const;
  /// Likewise the positions [m] of the embedded surface's points, [points][3], as level 0 carries
  /// them.
  void read_surface_positions(const DeviceOutput<B>& to) const;
  /// Likewise their velocities [m/s].
  void read_surface_velocities(const DeviceOutput<B>& to) const;

  /// The other way: replaces level 0's state by that in views of the caller's. The next cycle
  /// restricts it to the others. Enqueues, does not wait (but for cycle `him`, which solves for the
  /// momenta of these velocities); the views must stay as they are until the work is done.
  void write_state(const DeviceInput<B>& positions, const DeviceInput<B>& velocities);

  /// From now on asks this function for more forces, on every level, at every state about to be
  /// integrated; an empty one ends that. The library cannot know their stiffness: explicit levels
  /// are stable up to h^2 k < 4 m of a vertex they act on, about, and implicit ones take it from
  /// ForceRequest::stiffness. Since such forces may do work, check() no longer compares energies.
  void set_external_forces(const ExternalForces<B>& forces);

  /// From now on an obstacle moves so, not as the problem says; displacements are from where its
  /// shape says. Its turn goes on. Does not wait. save() does not store this motion; check() no
  /// longer compares energies. Obstacles count from 0. InputError where there is none of that
  /// number.
  void set_obstacle_motion(int obstacle, const Motion& motion);
  /// Likewise it turns so; none: it is as its shape says. Its motion goes on. One with mass and
  /// inertia follows by its coupling; InputError for one with mass alone, which does not turn.
  void set_obstacle_turn(int obstacle, const std::optional<Turn>& turn);
  /// Likewise straight from where its motion has it now to this displacement [m] at the end of the
  /// next macro step, where it stays: for tools that a hand or a haptic device moves. One with mass
  /// follows by its coupling.
  void move_obstacle(int obstacle, const Point& displacement);
  /// The same, and it turns in that time to this rotation, the shortest way and at one rate: about
  /// the point of its turn, or its origin.
  void move_obstacle(int obstacle, const Point& displacement, const Point& rotation);
  /// Where its motion has it now, from where its shape says [m].
  Point obstacle_displacement(int obstacle) const;
  /// How it is turned now: its direction is the axis, its length the angle, at most pi [rad].
  Point obstacle_rotation(int obstacle) const;
  /// Where its motion and its turn have now what torques on it are about [m].
  Point obstacle_origin(int obstacle) const;

  /// An obstacle takes hold of the surface points that touch it now, or are within its reach,
  /// besides those that it holds: springs tie them to where they are relative to it. Does not wait.
  /// InputError where the problem gives it no `grasp`.
  void grasp(int obstacle);
  /// It lets go of all of them.
  void release(int obstacle);

  /// of a level's vertices, input order [m]; waits
  std::vector<Point> positions(int level = 0) const;
  std::vector<Point> velocities(int level = 0) const;  ///< likewise [m/s]
  /// of the embedded surface's points [m]; waits
  std::vector<Point> surface_positions() const;
  std::vector<Point> surface_velocities() const;  ///< likewise [m/s]

  /// Replaces level 0's state: displacements and velocities, input order. The next cycle restricts
  /// it to the others.
  void set_state(const std::vector<Point>& displacement, const std::vector<Point>& velocity);

  /// From now on it is this time [s], which is finite: obstacles, loads and given motions are where
  /// they are then. The state stays.
  void set_time(double time);

  /// Everything to continue from here: all levels' states and histories, time, energy budget,
  /// counters. Waits. To be called after a step that passed check(); what a caller's own forces
  /// remember is the caller's.
  SavedState save() const;
  /// Continues as the saved simulation would have: the same bits, given the same problem, precision
  /// and back end. InputError for a state of other fields, sizes, precision or macro step, and then
  /// nothing has changed. Its numbers are not looked at.
  void restore(const SavedState& saved);

  /// Stress and volume of a level's elements, computed on the device; waits.
  ElementFields element_fields(int level = 0) const;

  /// From now on it takes fewer threads while other work has cores that it waits for, and more
  /// again when they are free: where kernels wait for a thread without a core, fewer are faster.
  /// The same bits. Does nothing on a device, or where the system does not tell who waits (Linux
  /// does). Steps are to be called one after the other: their wall times are compared.
  void share_cores();

  /// Whether launches that come again from step to step go out as CUDA graphs, as they do by
  /// default, or one by one. Results are the same. No effect on other back ends.
  void use_graphs(bool on);

  /// From now on measure the wall time of each stage (this waits between stages).
  void time_stages(bool on);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;

  bool repair(const Diagnosis& bad);
};

}  // namespace plica
