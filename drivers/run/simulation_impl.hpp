// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <plica/core/error.hpp>
#include <plica/core/launch.hpp>
#include <plica/drivers/loads/exchange.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>
#include <plica/drivers/run/busy_cores.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/drivers/run/motion_commands.hpp>
#include <plica/drivers/run/move_obstacles.hpp>
#include <plica/drivers/run/rank_fields.hpp>
#include <plica/drivers/run/reactions.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/run/step_control.hpp>
#include <plica/meshes/blade_front.hpp>
#include <plica/meshes/partly_refined.hpp>

namespace plica {

/// Lists the parts of a scene's simulation, each with the device memory that it takes.
template <class B>
std::vector<Part> list_parts(const Problem& problem, const BuiltHierarchy<B>& built);

/// Problem of a body in which more faces are open; see the members of the same names below.
struct OpenedBody {
  Problem problem;  ///< with the meshes that are in use
  std::vector<Faces> opened;
  std::vector<int> twins;
  CutReport report;
};

/// Functions that all ranks call together, where rank 0 leads.
enum class Call {
  end,
  go_on,
  step,
  step_checked,
  check,
  recover,
  return_to_last_good,
  return_to_step_start,
  keep_step_starts,
  end_at,
  energies,
  reactions,
  contact_depths,
  slipping,
  contact_pressure,
  positions,
  velocities,
  surface_positions,
  surface_velocities,
  element_fields,
  ranks,
  save,
  restore
};

/// A call of one of these functions. Where rank 0 leads, it tells the other ranks; what the
/// function calls in turn, it does not.
template <class S>
class LedCall {
 public:
  LedCall(S& s, Call call, double argument = 0, double other = 0) : s_(s.ranks ? &s : nullptr) {
    if (s_ && s_->calls++ == 0 && s_->leads) s_->tell(call, argument, other);
  }
  ~LedCall() {
    if (s_) --s_->calls;
  }
  LedCall(const LedCall&) = delete;
  LedCall& operator=(const LedCall&) = delete;

 private:
  S* s_;  // null: one process, whose data a cut may replace during the call
};

/// Data and functions of a simulation, for the sources that implement it.
template <class B>
struct Simulation<B>::Impl {
  Impl(const Problem& p, const Exec& exec, Validation validation, Ranks* of = nullptr);

  Problem problem;  // without meshes: those in use are in `built`
  BuiltHierarchy<B> built;
  LaunchQueue<Exec> queue;
  bool graphs = true;  // launches that repeat go out as CUDA graphs
  EnergyMeter<B> meter;
  // per level, rest positions of its vertices; empty until somebody has asked for positions
  std::vector<Vectors<B>> rest;
  // Triangles around the embedded surface's points, and these points' positions; none until
  // somebody has asked for normals
  std::optional<SurfaceFans<B>> fans;
  Vectors<B> surface_x;
  Reactions<B> held;

  // Present time and results
  double time = 0;
  long steps = 0;
  // origin of the time: macro step n ends at origin + n macro_step [s]
  double origin = 0;
  double end = std::numeric_limits<double>::infinity();  // no step goes beyond this time [s]
  double residual = 0, worst_residual = 0;

  // Wrenches, 6 numbers each: over the last macro step (where the run ends within one, over the one
  // before); over the step that is shorter than that; the sum over the parts of a step so far
  Doubles<B> wrench, wrench_shorter, wrench_sum;
  bool shorter = false;  // the last step was shorter: the run has ended within a macro step

  // Reference values of checks
  bool judges = false;           // a level's integrator tells whether it has solved a step
  bool linear = false;           // the material is linear in any state
  bool budget_known = false;     // nothing from outside but gravity does work
  bool budget_opens = false;     // the state was replaced: the next check starts a new budget
  double start = 0, put_in = 0;  // energy at the start; maximum that was ever put in [J]
  Point drift = Point::Zero();   // mean velocity at the last check [m/s]

  /// Snapshot: a state to go back to, and what belongs to it.
  struct Snapshot {
    std::vector<State<B>> levels;
    KeptValues<B> history;  ///< see name_history()
    double time = 0, put_in = 0;
    long steps = 0;
    Point drift = Point::Zero();
  };
  Doubles<B> memory;  // memory of obstacles: see Contact::memory()
  // The last snapshot, and one from long before: a state that looks good may have been going wrong
  // for a while. The older one only where the stepper can repair.
  Snapshot kept;
  std::optional<Snapshot> fallback;
  std::optional<Snapshot> step_start;  // see keep_step_starts()
  MotionCommands<B> motions;           // how callers have moved obstacles
  std::function<void()> after_repeated;

  StepControl control;  // division of macro steps that fail
  // number of parts of macro steps that were taken again; of parts that were taken though not
  // solved
  long rejected = 0, unsolved = 0;
  std::optional<Snapshot> part_start;  // snapshot at the start of a part, where parts are judged

  std::optional<SharedCores<B>> cores;  // only where cores are shared with other work

  // Cuts, see simulation_cut.cpp: the faces that each has opened, what they came to, and of each
  // new vertex the one that it was before
  std::vector<Faces> opened;
  CutReport cut_so_far;
  std::vector<int> twins;
  // time up to which blades have cut [s]: steps that are repeated do not cut again
  double cut_until = -std::numeric_limits<double>::infinity();
  // [cuts of the problem] how far each blade has come; none: it does not cut now
  std::vector<std::optional<BladeFront>> fronts;
  // Part that follows an obstacle, see simulation_follow.cpp: what its moves came to; per vertex of
  // this mesh what it is in the mesh that the part is made of; number of macro steps when the
  // obstacle was last looked at, which repeated steps do not do again
  FollowReport part_moves;
  std::vector<Ends> ends;
  long looked_at = -1;
  long mesh_changes = 0;       // number of times that level 0 was built again
  ExternalForces<B> external;  // the caller's, see set_external_forces()

  // Several ranks, see simulation_ranks.cpp
  Ranks* ranks = nullptr;  // null: one process
  bool leads = false, follows = false;
  Simulation* self = nullptr;  // this simulation, on a rank that follows
  int calls = 0;               // depth of calls that the others know of
  // numbers of surface points and of tetrahedra as the ranks have them, one rank after the other
  std::vector<int> joined_points;
  std::vector<std::vector<int>> joined_tets;  // per level
  double imbalance = 1;

  Hierarchy<B>& hierarchy() { return *built.hierarchy; }
  const Level<B>& level(int i);
  const Vectors<B>& rest_positions(int i);
  // throws InputError where there is no obstacle of that number
  const Contact<B>& contact_with(int obstacle) const;
  std::vector<Wrench> to_host(const Doubles<B>& numbers) const;  // 6 each: force, torque
  // grasps (closed) or releases; throws InputError where the obstacle has no grasp
  void hold_now(int obstacle, bool closed);
  void move(int obstacle, const typename MotionCommands<B>::Command& how);  // from now on
  // unbalanced part of the forces after the last part of a step: see Integrator::unsolved()
  double left_unsolved() const;

  // Steps
  bool reaches_end() const;
  double next_span() const;
  // calls take(), which takes the next macro step or what is left of it to the end of the run
  template <class Take>
  auto stepped(const Take& take) {
    shorter = reaches_end();
    if (shorter) copy_memory(hierarchy().exec(), wrench, wrench_shorter);
    auto result = take();
    if (shorter) {  // the mean force of a short step oscillates: that of the last whole step stays
      copy_memory(hierarchy().exec(), wrench, wrench_sum);
      copy_memory(hierarchy().exec(), wrench_shorter, wrench);
      copy_memory(hierarchy().exec(), wrench_sum, wrench_shorter);
    }
    return result;
  }
  void advance(double from, double span);
  void arrive();

  // Checks; `part`: part of a macro step that the last step covered
  std::optional<Diagnosis> examine(double part = 1);
  std::optional<Diagnosis> find_failure(const MotionReport& now, double motion);
  void look_at_end();
  Diagnosis failure(const std::string& kind, double motion = 0, int level = -1,
                    const std::string& reason = {});

  // Snapshots
  void keep_at_times();
  void keep(Snapshot& to);
  void reset_snapshots();
  void restore_snapshot(Snapshot& to);
  void name_history(Archive<B>& archive);
  void accept_state();
  void restart();
  void open_budget();

  // Level 0 that is built again
  Problem present_problem() const;
  void go_on_from(Impl& before);

  // Several ranks
  void join_numbers();
  void tell(Call call, double argument = 0, double other = 0) const;
  double follow(Call until);
  void call_after_repeated();
  bool is_led() const { return leads || follows; }
  // throws InputError where several ranks share the body
  void expect_one_process(const char* what) const;
  // returns values of own items; where rank 0 leads, all of them there
  std::vector<double> given(const std::vector<double>& own, int components = 1,
                            const std::vector<int>& order = {}) const;
  std::vector<Point> given(const std::vector<Point>& own, const std::vector<int>& order = {}) const;
  // returns the values of owned vertices or surface points, of those of local ones
  std::vector<Point> of_vertices(const std::vector<Point>& local, int level) const;
  std::vector<Point> of_points(const std::vector<Point>& local) const;
  int lost_point(const Contact<B>& contact);
  std::unique_ptr<RankFields> shared_fields();  // null: one process
  std::vector<unsigned char> bytes_of_first(const std::vector<unsigned char>& bytes) const;

  // Cuts
  OpenedBody with_open(const std::vector<Faces>& more) const;
  std::unique_ptr<Impl> rebuilt(OpenedBody&& body);
  std::unique_ptr<Impl> reopened(const std::vector<Faces>& saved);
  std::vector<int> carry_over_cuts(Impl& before);
  Faces open_so_far() const;

  // A part that follows an obstacle
  long steps_between_looks() const;
  std::unique_ptr<Impl> with_part(std::vector<int> refined);
  std::unique_ptr<Impl> with_saved_part(const std::optional<std::vector<int>>& saved);
  void carry_over_part(Impl& before);

  // Recovery
  std::optional<Diagnosis> cover(bool checks);
  std::optional<Diagnosis> retry(const Diagnosis& bad);
};

}  // namespace plica
