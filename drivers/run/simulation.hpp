// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <plica/core/backend.hpp>
#include <plica/core/device_array.hpp>
#include <plica/core/problem.hpp>
#include <plica/core/ranks.hpp>
#include <plica/core/reports.hpp>
#include <plica/drivers/loads/external_forces.hpp>
#include <plica/meshes/cut.hpp>
#include <string>
#include <vector>

namespace plica {

/// Check of a problem by validate().
enum class Validation {
  needed,  ///< the problem is still to be checked
  done     ///< the caller has checked it
};

/// A deformable body in motion, meshed at one or several resolutions (levels, the finest first).
/// Not copyable. Two threads must not use one object at the same time. Kokkos must be initialised
/// before the object is made, and finalised after it is destroyed.
template <class B>
class Simulation {
 public:
  using Exec = typename B::Exec;  ///< execution space of all kernels

  /// Builds levels, contact, integrators and the stepper. Throws InputError with the wrong values,
  /// the possible choices and the remedy.
  explicit Simulation(const Problem& problem, const Exec& exec = {},
                      Validation validation = Validation::needed);
  /// Builds this rank's part of a body that several ranks simulate together; all of them call this
  /// with the same problem. Results are those of one process, bit for bit. Throws InputError, on
  /// all of them, also for what only one process can simulate; see refused_by_ranks().
  ///
  /// From then on all ranks call the same functions in the same order. Vertices, elements and
  /// surface points in results are those that the rank owns; sums and diagnoses are of the whole
  /// body. Device views have local vertices, with copies of those of other ranks.
  Simulation(const Problem& problem, const Exec& exec, Ranks& ranks,
             Validation validation = Validation::needed);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Takes one macro step. Enqueues work and does not wait for it, except that implicit levels read
  /// their residuals during the step.
  ///
  /// Before it, blades of Problem::cuts cut, and a part that follows an obstacle is made anew where
  /// the obstacle has come near its border: an element within three quarters of the radius is not
  /// cut in eight yet. Level 0 is then built again, as by cut(). The displacements stay as they are
  /// where elements become finer, and lose what is finer than the others elsewhere. Momentum stays
  /// to rounding, linear and angular.
  ///
  /// Throws InputError, before it steps, where a blade of Problem::cuts leaves no stable step; that
  /// cut is left out.
  void step();

  /// Examines the present state and returns why the run must stop; none: it may go on. Waits.
  ///
  /// Reasons to stop are non-finite values; inverted elements where they are not allowed; more
  /// kinetic energy than was put in; a vertex that leaves the body by more than its edge in one
  /// explicit sub-step; a surface point deeper in an obstacle than the body is large; a solver that
  /// gave up; a stepper that has lost its stability. With integration.on_failure.halvings, level
  /// 0's elements are examined too, which takes one or two more passes over them.
  ///
  /// It is cheap enough for a call after every macro step. From time to time it takes a snapshot of
  /// a state that passes. After such a state, sub-steps that recover() has shortened may become
  /// longer again: every hundred macro steps at most, it tries whether longer ones are stable. Such
  /// a try takes as long as about ten steps.
  std::optional<Diagnosis> check();

  /// Repairs a state that did not pass check(), where that is possible. Goes back to the last
  /// snapshot and steps again to the same time: with the inertia fitted again (cycle him), or in
  /// halved steps (integration.on_failure). External forces are asked for again. Returns none where
  /// the run can go on. Else returns the diagnosis of a state that is still bad, and leaves that
  /// state as it is.
  std::optional<Diagnosis> recover(const Diagnosis& bad);

  /// Takes one macro step of a run: step(), check() and, where that finds something, recover().
  /// Waits. Returns none where the run can go on. Where a blade of Problem::cuts leaves no stable
  /// step, it returns a diagnosis of the kind "cut", and the state stays as it is.
  std::optional<Diagnosis> step_checked();

  /// Sets the time [s] at which the run ends; infinity: no end. From now on, a macro step that
  /// would go beyond this time ends there. It is shorter than the others and not counted in
  /// macro_steps(); the step after it covers the rest.
  void end_at(double time);

  /// Sets a function that is called after each macro step that recover() repeats. Calls come in the
  /// order of the steps; where a try fails, they start again from an earlier step. For programs
  /// that record motion: macro_steps() and time() say from which step on the record is replaced.
  void on_repeated_step(std::function<void()> call);
  /// Returns the macro step of the earliest snapshot that recover() may go back to. The snapshot
  /// was taken at the end of that step.
  long earliest_kept() const;

  /// Restores all levels and the time from the last snapshot.
  void return_to_last_good();

  /// Keeps the state before each macro step from now on, for return_to_step_start(), or no longer.
  /// Each step then copies the states of all levels once more.
  void keep_step_starts(bool on);
  /// Restores all levels and the time from before the last macro step, or from before the one that
  /// an exception has left. Without keep_step_starts(), from the last snapshot.
  void return_to_step_start();

  /// Makes rank 0 the one that calls: the others are in follow(). Results are then of the whole
  /// body, on rank 0 alone. It ends with the simulation there.
  void lead();
  /// Does what rank 0 calls, until its simulation ends or it calls dismiss(). Returns the status
  /// given there.
  int follow();
  /// Ends follow() on the other ranks, which return this status.
  void dismiss(int status);
  /// Returns the number in the whole mesh of each vertex that this rank owns, ascending.
  std::vector<int> numbers() const;
  /// Returns how ranks share the body; none: one process has all of it. All ranks call this.
  std::optional<RankReport> ranks() const;

  double time() const;                             ///< simulated time [s]
  double macro_step() const;                       ///< length of a macro step [s]
  long macro_steps() const;                        ///< number of macro steps taken so far
  const std::vector<LevelReport>& levels() const;  ///< levels that the cycle uses, finest first
  std::optional<HimReport> him() const;            ///< report of cycle him; none: another cycle
  std::vector<Part> parts() const;                 ///< parts of the simulation, in use or not
  Energies energies() const;                       ///< energies of level 0 [J]; waits
  /// Returns the wrenches of all obstacles, then of all bodies, over the last macro step [N, N m].
  /// After a step that end_at() made shorter, they are those of the macro step before it. Waits.
  std::vector<Wrench> wrenches() const;
  /// Returns the wrenches over the last step, also where end_at() made it shorter [N, N m]. Waits.
  std::vector<Wrench> wrenches_of_last_step() const;
  /// Returns what holds the vertices of body.fixed and body.prescribed now, on level 0 [N, N m].
  /// Forces are evaluated at the present state, one pass over the elements; contact's are the last
  /// ones, and a caller's own forces on these vertices are left out. Waits.
  std::vector<Reaction> reactions() const;
  /// Returns for each obstacle the largest depth of the surface in it [m]; 0: outside. Grasped
  /// points are left out. Waits.
  std::vector<double> contact_depths() const;
  /// Returns the largest depth of the surface in other bodies, or in itself where it folds [m].
  /// Waits.
  double pair_depth() const;
  /// Returns the pressure of contact at each point of the embedded surface [Pa]; 0 where nothing
  /// touches, no values without contact. It is the sum of the normal forces at the point, in the
  /// last sub-step of level 0, over a third of the area that the triangles around it have now.
  /// Obstacles, other bodies and the body itself press; grasps and attachments do not. Waits.
  std::vector<double> contact_pressure() const;
  /// Returns the work of friction so far, on the body and on everything that rubs it [J]. Work
  /// below 0 is energy that is lost, or stored where the body sticks. Waits.
  double friction_work() const;
  /// Returns for each obstacle which part of its contacts slips, from 0 to 1. A contact slips where
  /// its friction is at its cap. Waits.
  std::vector<double> slipping() const;
  std::vector<ToolState> tools() const;       ///< obstacles with mass; waits
  std::vector<HeldBy> held() const;           ///< points that obstacles have grasped; waits
  int torn_attachments() const;               ///< number of points with torn attachments; waits
  std::vector<CavityState> cavities() const;  ///< cavities of level 0 with a given volume; waits
  /// Returns the wrenches in device memory: for each obstacle or body, 3 numbers of force [N], then
  /// 3 of torque [N m]. step() updates them in place.
  Doubles<B> wrench() const;
  /// Returns the wall time of each stage so far [s], by the stage's name. Empty unless
  /// time_stages() was switched on.
  std::map<std::string, double> stages() const;
  /// Returns counters by name: force evaluations, solver iterations, misses, switched vertices ...
  std::map<std::string, long> counters() const;
  /// Returns the largest part of its forces that an implicit stage of the last macro step left
  /// unbalanced. For a linearly implicit stage, it is the relative residual of its linear solve.
  double residual() const;
  double worst_residual() const;  ///< largest residual() of all macro steps so far

  /// Returns a level's displacements from the placed rest mesh in device memory, [vertices][3] m.
  /// step() updates them in place; the view may outlive the simulation.
  Vectors<B> displacement(int level = 0) const;
  /// Returns a level's velocities in device memory, [vertices][3] m/s. step() updates them in
  /// place; the view may outlive the simulation.
  Vectors<B> velocity(int level = 0) const;

  /// Copies a level's positions [m] after the steps enqueued so far into a caller's device view.
  /// The view is [vertices][3] in input order, float or double, in any layout. Enqueues and does
  /// not wait; the first call for a level uploads its rest positions. Throws InputError where the
  /// sizes differ.
  void read_positions(const DeviceOutput<B>& to, int level = 0) const;
  /// Copies a level's velocities [m/s] after the steps enqueued so far into a caller's device view.
  /// The view is [vertices][3] in input order, float or double, in any layout. Enqueues and does
  /// not wait. Throws InputError where the sizes differ.
  void read_velocities(const DeviceOutput<B>& to, int level = 0) const;
  /// Copies the positions [m] of the embedded surface's points into a caller's device view. The
  /// view is [points][3], float or double, in any layout. The points move with level 0. Enqueues
  /// and does not wait. Throws InputError where the sizes differ.
  void read_surface_positions(const DeviceOutput<B>& to) const;
  /// Copies the velocities [m/s] of the embedded surface's points into a caller's device view. The
  /// view is [points][3], float or double, in any layout. The points move with level 0. Enqueues
  /// and does not wait. Throws InputError where the sizes differ.
  void read_surface_velocities(const DeviceOutput<B>& to) const;
  /// Copies the unit normals at the embedded surface's points, where these are now, into a caller's
  /// device view; see normals_of_points(). The view is [points][3], float or double, in any layout.
  /// Enqueues and does not wait; the first call uploads the triangles. Throws InputError where the
  /// sizes differ.
  void read_surface_normals(const DeviceOutput<B>& to) const;

  /// Replaces level 0's state by positions [m] and velocities [m/s] from a caller's device views.
  /// The next cycle restricts it to the other levels. Enqueues and does not wait; cycle `him` is
  /// the exception, since it solves for the momenta of these velocities. The views must stay as
  /// they are until the work is done.
  void write_state(const DeviceInput<B>& positions, const DeviceInput<B>& velocities);

  /// Sets a function that adds a caller's forces from now on; an empty one ends that. It is called
  /// on every level, at every state that is about to be integrated. The library cannot know the
  /// stiffness k of such forces. Explicit levels are stable up to about h^2 k < 4 m, with m of a
  /// vertex that the forces act on. Implicit levels take k from ForceRequest::stiffness. Since such
  /// forces may do work, check() then compares no energies.
  void set_external_forces(const ExternalForces<B>& forces);

  /// Sets how an obstacle moves from now on, instead of the motion in the problem. Displacements
  /// are relative to the place in its shape's options. How it turns is not changed. Does not wait.
  /// After this call, check() compares no energies. Obstacles count from 0; throws InputError where
  /// there is none of that number.
  void set_obstacle_motion(int obstacle, const Motion& motion);
  /// Sets how an obstacle turns from now on; none: it has the orientation of its shape's options.
  /// How it moves is not changed. An obstacle with mass and inertia follows by its coupling. Throws
  /// InputError for one with mass but without inertia, which does not turn. Does not wait. After
  /// this call, check() compares no energies.
  void set_obstacle_turn(int obstacle, const std::optional<Turn>& turn);
  /// Moves an obstacle straight to this displacement [m] at the end of the next macro step. It
  /// starts from where its motion has it now, and stays at the end. For tools that a hand or a
  /// haptic device moves. An obstacle with mass follows by its coupling.
  void move_obstacle(int obstacle, const Point& displacement);
  /// Moves an obstacle to a displacement [m] and a rotation vector [rad] at the end of the next
  /// macro step. It moves straight, and turns the shortest way at one rate: about the centre of its
  /// turn or, where it has none, about its origin.
  void move_obstacle(int obstacle, const Point& displacement, const Point& rotation);
  /// Returns an obstacle's displacement by its motion now, from the place in its shape's options
  /// [m].
  Point obstacle_displacement(int obstacle) const;
  /// Returns how an obstacle is turned now: the direction is the axis, the length the angle, at
  /// most pi [rad].
  Point obstacle_rotation(int obstacle) const;
  /// Returns the point about which torques on an obstacle are taken, as its motion and turn have
  /// moved it [m].
  Point obstacle_origin(int obstacle) const;

  /// Grasps the surface points that touch an obstacle now or are within its reach. It keeps the
  /// points that it has grasped before. Springs tie all of them to their places relative to the
  /// obstacle. Does not wait. Throws InputError where the problem gives the obstacle no `grasp`.
  void grasp(int obstacle);
  /// Releases all points that an obstacle has grasped. Throws InputError where the problem gives it
  /// no `grasp`.
  void release(int obstacle);

  /// Cuts the body along faces of level 0, between two macro steps. Faces open between tetrahedra
  /// whose centroids, where they are now, are on both sides of a triangle. Vertices split where
  /// faces join their tetrahedra no longer, and both keep their velocity: mass, momentum and volume
  /// stay, to rounding. Vertices at the front of the cut stay single. Waits.
  ///
  /// The level is built again from the mesh that is cut, with a new critical step; the macro step
  /// stays. So views and vectors from before the cut are those of the body before it. New vertices
  /// come after the others. Relaxing stresses, grasps and tools go on as they were. Contact and
  /// implicit integrators forget the last step, as after set_state(): friction sticks anew.
  ///
  /// A cut that meets nothing returns 0 opened faces, and changes nothing. Throws InputError, and
  /// changes nothing, where the cycle or the body cannot follow a cut, see refused_by_cuts(), and
  /// where no stable step is left.
  CutReport cut(const Blade& blade);
  CutReport cuts() const;  ///< all cuts so far, also those of Problem::cuts
  /// Returns level 0's mesh at rest, where it is placed. A cut replaces it, and so does a part that
  /// follows an obstacle.
  const TetMesh& mesh() const;
  /// Returns how often mesh() was replaced. Views, positions and velocities then have other sizes.
  long mesh_changes() const;
  /// Returns what became of the part that follows an obstacle (Body::following); zeros: there is
  /// none, or it has not moved.
  FollowReport followed() const;
  /// Returns of each vertex that cuts have added to level 0 the vertex that it was before.
  const std::vector<int>& twins() const;
  /// Returns the embedded surface at rest; none: there is none. A cut adds both of its sides.
  const std::optional<TriangleSurface>& surface() const;
  /// Returns, of a body that was cut, the vertex of level 0 at each point of its boundary; empty:
  /// it is whole. Points are those of surface(), where there is one. Cuts add points at the end.
  const std::vector<int>& surface_vertices() const;

  /// Returns the positions of a level's vertices, in input order [m]. Waits.
  std::vector<Point> positions(int level = 0) const;
  /// Returns the velocities of a level's vertices, in input order [m/s]. Waits.
  std::vector<Point> velocities(int level = 0) const;
  std::vector<Point> surface_positions() const;   ///< positions of surface points [m]; waits
  std::vector<Point> surface_velocities() const;  ///< velocities of surface points [m/s]; waits
  std::vector<Point> surface_normals() const;     ///< unit normals at surface points; waits

  /// Replaces level 0's displacements [m] and velocities [m/s], in input order. The next cycle
  /// restricts them to the other levels. Throws InputError where sizes differ or a number is not
  /// finite.
  void set_state(const std::vector<Point>& displacement, const std::vector<Point>& velocity);

  /// Sets the present time [s], which must be finite. Obstacles, loads and prescribed motions
  /// continue from where they are at that time. The state stays.
  void set_time(double time);

  /// Sets the acceleration of everything that is free from now on [m/s^2], instead of the
  /// problem's. save() does not store it. Waits. Throws InputError for a number that is not finite.
  void set_gravity(const Point& gravity);

  /// Saves everything that is needed to continue from here: states and histories of all levels,
  /// time, energy budget, counters, and how callers have moved obstacles. Waits. Call it after a
  /// step that passed check(). A caller saves what its own forces remember. On several ranks the
  /// bytes are those of one process; rank 0 gets them, and the others none.
  SavedState save() const;
  /// Restores a saved state, and continues as the saved simulation would have. Results have the
  /// same bits, given the same problem, precision and back end. Cuts that the saved simulation has
  /// made since are made again. Throws InputError for a state of
  /// other fields, sizes, precision or macro step, and then changes nothing. The state's numbers
  /// are not checked. Several ranks, any number of them, restore what rank 0 has, and all throw
  /// what it throws.
  void restore(const SavedState& saved);

  /// Returns stress and volume ratio of a level's elements, computed on the device. Waits.
  /// `tensors`: also the whole stress, pressure and principal stretches.
  ///
  /// Where pressures of nodal elements are smoothed, all of them have the smoothed volume ratio,
  /// with which the law works; an inverted domain has its own. With several regions at a vertex, a
  /// value is the mean by volume; stretches are those of the mean F^T F.
  ElementFields element_fields(int level = 0, bool tensors = false) const;

  /// Uses fewer threads from now on while other work takes cores, and more again when they are
  /// free. Where kernels wait for a thread without a core, fewer threads are faster. Results have
  /// the same bits. Has no effect on a device, or where the system does not tell which threads wait
  /// (Linux does). Call steps one after the other, since their wall times are compared.
  void share_cores();

  /// Switches CUDA graphs for launches that repeat from step to step on (the default) or off. Off,
  /// each kernel is launched alone. Results are the same. Has no effect on other back ends.
  void use_graphs(bool on);

  /// Switches the measurement of each stage's wall time on or off. While it is on, steps wait
  /// between stages.
  void time_stages(bool on);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;

  bool repair(const Diagnosis& bad);
  void cut_ahead();
  /// Cuts as cut_ahead() does. Returns a diagnosis where no stable step is left after it.
  std::optional<Diagnosis> cut_checked();
  void follow_ahead();
  Point followed_place() const;
};

}  // namespace plica
