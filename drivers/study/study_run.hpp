// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <optional>
#include <plica/core/problem.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/limit.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <plica/drivers/study/trajectory.hpp>
#include <string>

namespace plica {

/// How a problem is to be run and measured.
struct StudyRunOptions {
  double duration = 0;               ///< [s] > 0
  std::vector<double> sample_times;  ///< within the duration [s]
  std::string precision = "double";  ///< float | double
  int threads = 0;                   ///< of the default execution space; 0: all that it has
  int timed_runs = 3;                ///< 0: only the sampled run, which is the one that is timed
  const Embedding* at = nullptr;     ///< points of level 0 that are sampled; null: its vertices
  std::function<bool(double)> go_on =
      {};  ///< asked from time to time with the part of the work that is done; false ends the run
};

struct StudyRun {
  std::string status = "completed";  ///< completed | diverged | refused | stopped
  std::string reason;                ///< diagnosis or message, where it is not completed
  double macro_step = 0;             ///< [s]
  long macro_steps = 0;              ///< for the whole duration
  double reached = 0;                ///< simulated [s]
  Trajectory trajectory;             ///< level 0's, where it is completed
  double setup_time = 0;             ///< [s]
  /// of the steps and their checks: the median of the timed runs [s]
  double wall_time = 0;
  double wall_time_spread = 0;         ///< the longest less the shortest of them [s]
  int timed_runs = 0;                  ///< see timed_runs_of()
  long tet_evaluations = 0;            ///< forces of all levels' tetrahedra, in one run
  std::optional<double> energy_drift;  ///< (at the end - at the start) / the most there was of
                                       ///< kinetic, elastic and contact energy; none where loads,
                                       ///< given motions, damping or contact do unknown work
};

/// How often a run that takes so long [s] is timed where `asked` is asked for: short ones at least
/// five times.
int timed_runs_of(double wall_time, int asked);

/// InputError where the default execution space cannot run with so many threads of its own; 0: all.
void check_threads(int threads);

/// Runs the problem on Kokkos' default execution space: once to warm up, sampling its states, then
/// timed, from the same start. A set-up that refuses is a result too. Whole macro steps: the last
/// one may reach beyond the duration. InputError for an unknown precision, or more threads than
/// there are.
StudyRun study_run(const Problem& problem, const StudyRunOptions& options);

/// What errors are measured against: the finest level alone, in double, at a small step that hits
/// every sampling time, whose own error is how far it is from a run at twice that step: more than
/// it really is; or the truth, see make_truth().
struct StudyReference {
  std::string method;
  double macro_step = 0;                         ///< [s]
  double critical_step = 0;                      ///< of the finest level under symplectic Euler [s]
  double own_error = 0, own_error_velocity = 0;  ///< fractions
  double wall_time = 0;                          ///< of its runs [s]
  double seconds_per_evaluation = 0;             ///< of a tetrahedron
  std::optional<double> space_error;             ///< to the finer mesh's reference, displacement
  Trajectory trajectory;                         ///< empty: there is none yet
  /// of the finer mesh's reference, at the finest level's vertices
  std::optional<Trajectory> finer;
  std::optional<Truth> truth;  ///< none: errors are those in time
  /// the truth's, of the options' probes in their order
  Trajectory probes;
  std::vector<MeshReference> meshes;  ///< with truth, of each kind of elements and level
};

/// Level 0 alone by that integrator, in double, at a step that hits every sampling time and is no
/// longer than `longest_step` [s]; half of it, and half of that, where it does not come to its end.
/// InputError where it never does; stopped where go_on says so.
StudyRun run_to_samples(const Problem& problem, const StudyOptions& options,
                        const std::string& integrator, double longest_step,
                        const std::function<bool(double)>& go_on, const Embedding* at = nullptr);

/// Runs it, and the one on options.finer where there is one. Empty trajectory where go_on ended it.
/// InputError where it diverges, also at an eighth of the step.
StudyReference make_reference(const Problem& problem, const StudyOptions& options,
                              double critical_step, const std::function<bool(double)>& go_on);

}  // namespace plica
