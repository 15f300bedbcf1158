// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/drivers/study/study_case.hpp>
#include <plica/drivers/study/study_run.hpp>

namespace plica {

/// One method at one macro step, measured. Errors are fractions, times [s] of the whole duration;
/// what does not apply is empty.
struct StudyRow {
  std::string method, distribution, variant;       ///< see StudyCase
  std::optional<double> macro_step;                ///< [s]; none: refused before there was one
  bool automatic = false;                          ///< the macro step was `auto`
  std::optional<double> macro_step_over_critical;  ///< of the finest level under symplectic Euler,
                                                   ///< whatever the row runs
  std::string element;                             ///< of its levels
  std::string precision;
  int threads = 0;
  /// completed | diverged | refused
  std::string status;
  /// diagnosis or message, where it is not completed
  std::string reason;
  /// diverged: simulated time until then [s]
  std::optional<double> reached;
  /// see StudyErrors, against the reference
  std::optional<double> error, error_velocity, error_worst_vertex;
  std::optional<double>
      total_error;  ///< against the truth, where that is the reference; `error` is then against the
                    ///< row's own mesh, converged in time: total_error <= space_error + error
  /// of that mesh and its elements, converged in time, against the truth
  std::optional<double> space_error;
  /// like error, against the finer mesh's reference: space and time together
  std::optional<double> error_finer;
  /// of displacement, of each probe: see error_at()
  std::map<std::string, std::optional<double>> error_probes;
  std::optional<double> energy_drift;  ///< see StudyRun
  std::optional<double> phase;         ///< [s], see delay_of(); of motion that has an energy drift
  std::optional<double> wall_time, wall_time_spread, setup_time;
  int timed_runs = 0;
  std::optional<double>
      work;  ///< tetrahedra's force evaluations, to those of single/symplectic_euler at 0.9 of its
             ///< limit; diverged: what the whole duration would have taken, predicted
  /// see CycleGrowth
  std::optional<double> spectral_radius, spectral_radius_uncertainty, growth_per_second;
  bool pareto = false;  ///< completed, and no other row is as fast with a smaller error
  std::string key;      ///< StudyCase::key()
  std::string label() const { return study_label(method, distribution, variant); }
  /// What the front is drawn by.
  const std::optional<double>& judged() const { return total_error ? total_error : error; }
};

/// A case that was not run, and why.
struct LeftOut {
  std::string key;
  std::string reason;
};

struct StudyResult {
  StudyReference reference;
  std::vector<StudyRow> rows;  ///< in the order of study_cases()
  std::vector<LeftOut> left_out;
  bool stopped = false;  ///< by the caller, before all was done
};

/// How far a study is.
struct StudyProgress {
  std::string doing;             ///< "reference", or a case's key
  std::size_t done = 0, of = 0;  ///< cases
  double part = 0;               ///< of what it is doing
  const StudyResult* so_far = nullptr;
  bool new_reference = false, new_row = false;  ///< since the last call
};

/// Called after the reference, after every row, and some times a second; false stops the study.
using StudyWatch = std::function<bool(const StudyProgress&)>;

/// Measures the methods' errors against their run times. The problem's own integration is what
/// cycles take their options from. With a budget, controls come first, with one run each where more
/// do not fit, then the other rows in the order of what they tell.
/// @param before  what another study of the same problem and options has found: its reference and
/// rows are taken over InputError for bad options or problems; methods that refuse or diverge are
/// rows. Kokkos must be initialised.
StudyResult study(const Problem& problem, const StudyOptions& options, const StudyWatch& watch = {},
                  StudyResult before = {});

/// Sets `pareto` of every row: completed, and none is faster with an error as small, or as fast
/// with a smaller one.
void mark_pareto(std::vector<StudyRow>& rows);

/// Small motions about rest grow by this cycle, by more than rounding and the uncertainty of what
/// was found.
bool grows(const StudyRow& row);

/// The smallest error of the rows that are completed.
std::optional<double> smallest_error(const std::vector<StudyRow>& rows);

/// An error this small can be told: the reference's own is at most a tenth of it.
bool resolves(const StudyReference& reference, double error);

/// Every error reported can be told.
bool good_enough(const StudyResult& result);

/// The fastest completed row with an error below this, null where there is none.
const StudyRow* fastest_below(const std::vector<StudyRow>& rows, double error);

}  // namespace plica
