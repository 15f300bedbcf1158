// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/drivers/study/study_case.hpp>
#include <plica/drivers/study/study_run.hpp>

namespace plica {

/// Measured results of one method at one macro step. Errors are fractions; wall times are those of
/// the whole duration [s]. A value that does not apply is empty.
struct StudyRow {
  std::string method;        ///< name of the method, see StudyCase
  std::string distribution;  ///< distribution of a cycle; with cycle/auto its error class
  std::string variant;       ///< variant of a cycle, by name; empty: the problem's own settings
  std::optional<double> macro_step;  ///< [s]; none: refused before it was known
  bool automatic = false;            ///< true where the macro step was `auto`
  /// macro step over the critical step of the finest level under symplectic Euler, for any method
  std::optional<double> macro_step_over_critical;
  std::string element;    ///< kind of elements of its levels
  std::string precision;  ///< float | double
  int threads = 0;        ///< number of threads
  /// completed | diverged | refused
  std::string status;
  /// diagnosis or message, where the run did not complete
  std::string reason;
  /// diverged: simulated time until the failure [s]
  std::optional<double> reached;
  /// displacement error against the reference, see StudyErrors
  std::optional<double> error;
  /// velocity error against the reference, see StudyErrors
  std::optional<double> error_velocity;
  /// displacement error of the worst vertex against the reference, see StudyErrors
  std::optional<double> error_worst_vertex;
  /// error against the truth, where the truth is the reference. `error` is then against the row's
  /// own mesh, converged in time: total_error <= space_error + error
  std::optional<double> total_error;
  /// error against the truth of the row's own mesh and elements, converged in time
  std::optional<double> space_error;
  /// displacement error against the finer mesh's reference: space and time together
  std::optional<double> error_finer;
  /// displacement error of each probe, by name: see error_at()
  std::map<std::string, std::optional<double>> error_probes;
  std::optional<double> energy_drift;  ///< see StudyRun
  std::optional<double> phase;         ///< [s], see delay_of(); only with an energy drift
  std::optional<double> wall_time;     ///< median over the timed runs [s]
  /// longest less shortest wall time of the timed runs [s]
  std::optional<double> wall_time_spread;
  std::optional<double> setup_time;  ///< wall time of the set-up [s]
  int timed_runs = 0;                ///< number of runs that `wall_time` is the median of
  /// tetrahedra's force evaluations over those of single/symplectic_euler at 0.9 of its limit;
  /// diverged: predicted for the whole duration
  std::optional<double> work;
  /// factor by which small motions grow in a macro step, in the long run, see CycleGrowth
  std::optional<double> spectral_radius;
  std::optional<double> spectral_radius_uncertainty;  ///< uncertainty of `spectral_radius`
  /// log(spectral_radius) over the macro step [1/s]; > 0: small motions grow
  std::optional<double> growth_per_second;
  bool pareto = false;  ///< true for a row on the Pareto front, see mark_pareto()
  std::string key;      ///< StudyCase::key()
  /// Returns the name of the row, for example "cycle/rsv/critical+hybrid".
  std::string label() const { return study_label(method, distribution, variant); }
  /// Returns the error by which the Pareto front is drawn.
  const std::optional<double>& judged() const { return total_error ? total_error : error; }
};

/// A case that was not run, and why.
struct LeftOut {
  std::string key;     ///< StudyCase::key(); after "growth of " where only the growth is left out
  std::string reason;  ///< why it was not run
};

/// Reference and rows of a study.
struct StudyResult {
  StudyReference reference;       ///< motion against which errors are measured
  std::vector<StudyRow> rows;     ///< in the order of study_cases()
  std::vector<LeftOut> left_out;  ///< cases that were not run
  bool stopped = false;           ///< true where the caller ended the study early
};

/// Progress of a study.
struct StudyProgress {
  /// "reference", "truth: " and the name of a run, a case's key, or "growth of " and the key
  std::string doing;
  std::size_t done = 0;                 ///< number of rows so far
  std::size_t of = 0;                   ///< number of cases
  double part = 0;                      ///< part of the work on `doing` that is done
  const StudyResult* so_far = nullptr;  ///< result so far
  bool new_reference = false;           ///< true in the first call with the complete reference
  bool new_row = false;  ///< true where a row was added, or got its growth, since the last call
};

/// Function called after the reference, after every row, and several times a second; false stops
/// the study.
using StudyWatch = std::function<bool(const StudyProgress&)>;

/// Measures errors and run times of the methods. Cycles take their options from the problem's own
/// integration. With a budget, controls come first, with one run each where more do not fit. The
/// other rows follow in the order of StudyCase::rank.
///
/// Throws InputError for bad options or problems; methods that refuse or diverge are rows. Kokkos
/// must be initialised.
/// @param problem  problem to be simulated
/// @param options  methods to compare, and settings
/// @param watch    function called with the progress; empty: none
/// @param before   result of another study of the same problem and options, whose reference and
///                 rows are kept
StudyResult study(const Problem& problem, const StudyOptions& options, const StudyWatch& watch = {},
                  StudyResult before = {});

/// Sets `pareto` of every row. It is true for a completed row where no other row is faster with an
/// error as small, or as fast with a smaller error.
void mark_pareto(std::vector<StudyRow>& rows);

/// Returns whether small motions about rest grow by this row's cycle. The growth must be more than
/// rounding and the uncertainty of the spectral radius.
bool grows(const StudyRow& row);

/// Returns the smallest error of the completed rows; none where no row is.
std::optional<double> smallest_error(const std::vector<StudyRow>& rows);

/// Returns whether an error can be resolved: the reference's own error is at most a tenth of it.
bool resolves(const StudyReference& reference, double error);

/// Returns whether the reference resolves every error of the rows.
bool good_enough(const StudyResult& result);

/// Returns the fastest completed row with an error below `error`; null where there is none.
const StudyRow* fastest_below(const std::vector<StudyRow>& rows, double error);

}  // namespace plica
