// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <optional>
#include <plica/core/error.hpp>
#include <plica/core/launch.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>
#include <plica/drivers/run/busy_cores.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/drivers/run/motion_log.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/run/step_control.hpp>

namespace plica {

/// Which parts a scene's simulation consists of, each with the device memory it takes.
template <class B>
std::vector<Part> list_parts(const Problem& problem, const BuiltHierarchy<B>& built);

template <class B>
using KeptStress = typename Viscosity<B>::Kept;

/// What a simulation owns, for the sources that implement it.
template <class B>
struct Simulation<B>::Inside {
  Inside(const Problem& p, const Exec& exec);

  Problem problem;  // without meshes: those in use are in `built`
  BuiltHierarchy<B> built;
  LaunchQueue<Exec> queue;
  bool graphs = true;  // of launches that come again
  EnergyMeter<B> meter;
  std::vector<Vectors<B>> rest;  // of each level's vertices, where somebody has asked for positions

  // Now
  double time = 0;
  long steps = 0;
  // of the time: macro step n ends at origin + n macro_step
  double origin = 0;
  double end = std::numeric_limits<double>::infinity();  // no step goes beyond it
  double residual = 0, worst_residual = 0;

  // Of each obstacle, over the last macro step; where the run ends within one, over the one before;
  // the sum over the parts of one so far
  Doubles<B> wrench, wrench_before, wrench_sum;

  // What checks compare with
  bool judges = false;           // a level's integrator tells whether it has solved a step
  bool linear = false;           // the material is, in any state
  bool budget_known = false;     // nothing from outside but gravity does work
  bool budget_opens = false;     // anew at the next check: the state has been replaced since
  double start = 0, put_in = 0;  // energy at the start, the most that was ever there to be had [J]
  Point drift = Point::Zero();   // mean velocity at the last check [m/s]

  /// A state to go back to, and what goes with it.
  struct Kept {
    std::vector<State<B>> levels;
    std::vector<KeptStress<B>> stress;  ///< of viscous materials only
    Doubles<B> memory;                  ///< of obstacles: see Contact::memory()
    std::vector<typename ContactResponse<B>::Kept> contact;
    double time = 0, put_in = 0;
    long steps = 0;
    Point drift = Point::Zero();
  };
  Doubles<B> memory;  // of obstacles
  // The last state that was kept, and one from long before: what looks sound may have been going
  // wrong for a while. The latter only where the stepper can repair.
  Kept kept;
  std::optional<Kept> older;
  MotionLog<B> motions;  // of obstacles
  std::function<void()> after_repeated;

  StepControl control;  // of macro steps that fail
  // parts of macro steps that were taken again; that were taken though not solved
  long rejected = 0, unsolved = 0;
  std::optional<Kept> part_start;  // where parts are judged

  std::optional<SharedCores<B>> cores;  // where it shares them with other work

  Hierarchy<B>& hierarchy() { return *built.hierarchy; }
  const SolverLevel<B>& level(int i);
  const Vectors<B>& rest_positions(int i);
  // InputError where there is none of that number
  const Contact<B>& contact_with(int obstacle) const;
  // InputError where it has no grasp
  void hold_now(int obstacle, bool closed);
  void move(int obstacle, const typename MotionLog<B>::Said& how);  // from now on
  // of the last part: see Integrator::unsolved()
  double left_unsolved() const;

  // Steps
  bool reaches_end() const;
  double next_span() const;
  void advance(double from, double span);
  void arrive();

  // Checks; `part`: of a macro step, that the last step covered
  std::optional<Diagnosis> examine(double part = 1);
  std::optional<Diagnosis> find_failure(const MotionReport& now, double motion);
  void look_at_end();
  Diagnosis failure(const std::string& kind, double motion = 0, int level = -1,
                    const std::string& reason = {});

  // Kept states
  void keep_at_times();
  void keep(Kept& to);
  void keep_anew();
  void go_back(const Kept& to);
  void remember();
  void restart();
  void open_budget();

  // Recovery
  std::optional<Diagnosis> cover(bool checks);
  std::optional<Diagnosis> retry(const Diagnosis& bad);
};

}  // namespace plica
