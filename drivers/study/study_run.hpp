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

/// Settings of study_run().
struct StudyRunOptions {
  double duration = 0;               ///< [s] > 0
  std::vector<double> sample_times;  ///< times at which states are sampled, within the duration [s]
  std::string precision = "double";  ///< float | double
  int threads = 0;                   ///< threads of the default execution space; 0: all
  int timed_runs = 3;                ///< 0: only the sampled run, which is timed itself
  const Embedding* at = nullptr;     ///< points of level 0 to sample; null: its vertices
  /// called several times a second with the part of the work that is done; false ends the run
  std::function<bool(double)> go_on = {};
};

/// Result of study_run().
struct StudyRun {
  std::string status = "completed";  ///< completed | diverged | refused | stopped
  std::string reason;                ///< diagnosis or message, where not completed
  double macro_step = 0;             ///< [s]
  long macro_steps = 0;              ///< number for the whole duration
  double reached = 0;                ///< simulated time [s]
  Trajectory trajectory;             ///< motion of level 0, where completed
  double setup_time = 0;             ///< wall time [s]
  /// wall time of the steps and their checks, median of the timed runs [s]
  double wall_time = 0;
  double wall_time_spread = 0;  ///< longest less shortest wall time of the runs [s]
  int timed_runs = 0;           ///< see timed_runs_of()
  long tet_evaluations = 0;     ///< force evaluations of all levels, in one run
  /// change of the total energy over the maximum of kinetic, elastic and contact energy together.
  /// None where loads, given motions, damping or contact do unknown work
  std::optional<double> energy_drift;
};

/// Returns how often a run is timed. Short runs are timed at least five times.
/// @param wall_time  of one run [s]
/// @param asked      number asked for; 0 stays 0
int timed_runs_of(double wall_time, int asked);

/// Throws InputError where the default execution space cannot run with this number of threads; 0:
/// all.
void check_threads(int threads);

/// Runs the problem on Kokkos' default execution space. The first run warms up and samples the
/// states; timed runs from the same start follow. A set-up that refuses is a result too. Macro
/// steps are whole: the last one may reach beyond the duration. Throws InputError for an unknown
/// precision, or for more threads than there are.
StudyRun study_run(const Problem& problem, const StudyRunOptions& options);

/// Motion against which errors are measured. It is the finest level alone, in double, at a small
/// step that hits every sampling time, or the truth, see make_truth(). The own error of the former
/// is its distance from a run at twice the step, which is more than its real error.
struct StudyReference {
  std::string method;
  double macro_step = 0;  ///< [s]
  /// critical step of the finest level under symplectic Euler [s]
  double critical_step = 0;
  double own_error = 0, own_error_velocity = 0;  ///< fractions
  double wall_time = 0;                          ///< wall time of its runs [s]
  double seconds_per_evaluation = 0;             ///< wall time per force of a tetrahedron [s]
  std::optional<double> space_error;             ///< displacement, to the finer mesh's reference
  Trajectory trajectory;                         ///< empty: there is none yet
  /// motion of the finer mesh's reference, at the finest level's vertices
  std::optional<Trajectory> finer;
  std::optional<Truth> truth;  ///< none: errors are those in time
  /// true motion of the options' probes, in their order
  Trajectory probes;
  std::vector<MeshReference> meshes;  ///< with truth: one per kind of elements and level
};

/// Runs level 0 alone with an integrator, in double, at a step that hits every sampling time. The
/// step is halved up to three times where the run does not complete. Throws InputError where it
/// never completes; the status is `stopped` where go_on ended it.
/// @param longest_step  maximum step [s]
StudyRun run_to_samples(const Problem& problem, const StudyOptions& options,
                        const std::string& integrator, double longest_step,
                        const std::function<bool(double)>& go_on, const Embedding* at = nullptr);

/// Computes the reference, and that on options.finer where there is one. The trajectory is empty
/// where go_on ended it. Throws InputError where the run diverges even at an eighth of the step.
StudyReference make_reference(const Problem& problem, const StudyOptions& options,
                              double critical_step, const std::function<bool(double)>& go_on);

}  // namespace plica
