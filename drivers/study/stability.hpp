// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/study_case.hpp>

namespace plica {

/// Range of the search for a largest stable step.
struct StepRange {
  double guess = 0;  ///< first step tried [s]
  double least = 0;  ///< shortest step tried: a method unstable there is `growing` [s]
  double most = 0;   ///< longest step tried: a method stable there is `unlimited` [s]
  double ratio = 0;  ///< ratio of the first two steps tried, > 1; it is squared with every step
  double close = 0;  ///< relative width at which the bisection ends
};

/// Result of the search for a largest stable step.
struct LargestStep {
  /// Outcome of the search.
  enum class Kind {
    limited,   ///< a largest stable step was found
    growing,   ///< even the shortest step tried is unstable
    unlimited  ///< even the longest step tried is stable
  };
  Kind kind = Kind::limited;  ///< outcome of the search
  double step = 0;            ///< largest stable step found; growing: smallest unstable one [s]
};

/// Finds the largest stable step near the guess. It brackets the step at which stable(step) becomes
/// false, then bisects the logarithm of the step.
template <class Stable>
LargestStep largest_stable(const StepRange& range, const Stable& stable) {
  double low = range.guess, high = range.guess, ratio = range.ratio;
  if (stable(range.guess)) {
    for (bool going = true; going; ratio *= ratio) {
      if (low >= range.most) return {LargestStep::Kind::unlimited, low};
      high = std::min(low * ratio, range.most);
      going = stable(high);
      if (going) low = high;
    }
  } else {
    for (bool going = true; going; ratio *= ratio) {
      if (high <= range.least) return {LargestStep::Kind::growing, high};
      low = std::max(high / ratio, range.least);
      going = !stable(low);
      if (going) high = low;
    }
  }
  while (high > low * (1 + range.close)) {
    const double middle = std::sqrt(low * high);
    (stable(middle) ? low : high) = middle;
  }
  return {LargestStep::Kind::limited, low};
}

/// Largest macro step at which a method completes the scene itself, from its own start under its
/// own loads.
struct SceneLimit {
  /// largest macro step at which the run completed [s]; none: no run completed
  std::optional<double> step;
  /// smallest macro step at which the run failed [s]; none: no run failed
  std::optional<double> failed_step;
  double failed_time = 0;            ///< simulated time until the failure [s]
  std::string reason;                ///< diagnosis or message of the failure
  std::optional<Diagnosis> failure;  ///< place and kind; none where the set-up refused
};

/// Stability of a method on one problem.
struct StabilityRow {
  std::string method;        ///< name of the method, see StudyCase
  std::string distribution;  ///< distribution of a cycle; with cycle/auto its error class
  std::string variant;       ///< variant of a cycle, by name; empty: the problem's own settings
  std::string integrator;    ///< with a level alone: its integrator
  /// limited | unlimited: stable up to stable_up_to | growing: at every useful step | refused
  std::string status;
  std::string reason;  ///< why it is refused
  /// critical step of its finest level under symplectic Euler, contact included [s]
  double critical_step = 0;
  /// predicted largest stable macro step of small motions [s]; 0: none; empty: no limit
  std::optional<double> predicted;
  std::optional<double> measured;      ///< largest stable macro step of small motions in runs [s]
  std::optional<double> ratio;         ///< measured over predicted
  std::optional<double> stable_up_to;  ///< unlimited: the largest macro step that was run [s]
  std::optional<double> growth_step;   ///< macro step of `spectral_radius` [s]
  /// factor by which small motions grow in a macro step, in the long run. It is there for cycles
  /// and for methods that are growing, see CycleGrowth
  std::optional<double> spectral_radius;
  /// log(spectral_radius) over the macro step [1/s]; > 0: small motions grow
  std::optional<double> growth_per_second;
  /// limit of the scene itself; none where small motions tell all: `linear` without obstacles
  std::optional<SceneLimit> scene;
  /// Returns the name of the row, for example "cycle/rsv/critical+hybrid" or "coarse/1, rk4".
  std::string label() const;
};

/// Rows of all methods, and the methods that were left out.
struct StabilityResult {
  std::vector<StabilityRow> rows;     ///< one per examined method
  std::vector<std::string> left_out;  ///< methods for which time was short
  bool stopped = false;               ///< true where the caller ended it early
};

/// Progress of a search.
struct StabilityProgress {
  std::string doing;                        ///< label of the method that is examined
  std::size_t done = 0;                     ///< number of rows so far
  std::size_t of = 0;                       ///< number of methods
  const StabilityResult* so_far = nullptr;  ///< result so far
  bool new_row = false;                     ///< true where a row was added since the last call
};

/// Function called before, during and after every method; false stops the search.
using StabilityWatch = std::function<bool(const StabilityProgress&)>;

/// Finds the largest stable macro step of each method and compares it with the predicted one. It
/// uses bisection on runs of small motions. Small motions are linearised about rest, without loads
/// and contact, see small_motion.hpp.
///
/// For a level alone the prediction is that of its set-up. For cycle him it is the limit of the
/// inertia of its own macro step, 2 / sqrt(lambda). For the other cycles it is the step at which
/// the spectral radius of the map exceeds 1 by more than such a run can detect.
///
/// Throws InputError for bad options or problems; methods that refuse are rows. Kokkos must be
/// initialised.
/// @param problem  problem whose methods are examined
/// @param options  used are the methods (empty: all, explicit integrators on coarser levels too),
///                 variants, duration, budget, and the first precision
/// @param watch    function called with the progress; empty: none
StabilityResult stability(const Problem& problem, const StudyOptions& options,
                          const StabilityWatch& watch = {});

}  // namespace plica
