// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/study_case.hpp>

namespace plica {

/// Where the search for a largest stable step looks.
struct StepRange {
  double guess = 0;  ///< where it starts [s]
  double least = 0;  ///< a method unstable there is not looked at any further [s]
  double most = 0;   ///< nor one stable there [s]
  double ratio = 0;  ///< of the first two steps tried, > 1; further ones are ever further apart
  double close = 0;  ///< relative width at which the bisection ends
};

/// What it found.
struct LargestStep {
  enum class Kind { limited, growing, unlimited } kind = Kind::limited;
  double step = 0;  ///< the largest seen stable; growing: the smallest seen unstable [s]
};

/// Brackets the step at which stable(step) turns false nearest to the guess, then bisects its
/// logarithm.
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

/// The largest step of the scene itself, from its own start under its own loads, with a method.
struct SceneLimit {
  /// the largest macro step with which it came to its end [s]; none: no step tried did
  std::optional<double> step;
  /// the smallest with which it did not [s]; none: every step tried did
  std::optional<double> failed_step;
  double failed_time = 0;            ///< simulated until then [s]
  std::string reason;                ///< diagnosis or message
  std::optional<Diagnosis> failure;  ///< where and how; none where the set-up refused
};

/// The stability of a method on one problem.
struct StabilityRow {
  std::string method, distribution, variant;  ///< see StudyCase
  std::string integrator;                     ///< of a level alone
  /// limited | unlimited: up to stable_up_to | growing: at every useful step | refused
  std::string status;
  std::string reason;        ///< where it is refused
  double critical_step = 0;  ///< of its finest level under symplectic Euler, contact included [s]
  /// largest stable macro step of small motions [s]; 0: none; empty: no limit
  std::optional<double> predicted;
  std::optional<double> measured;      ///< the same by runs [s]
  std::optional<double> ratio;         ///< measured over predicted
  std::optional<double> stable_up_to;  ///< unlimited: the largest macro step that was run [s]
  std::optional<double> growth_step;   ///< macro step [s] of
  /// see CycleGrowth; of cycles, and of what is growing
  std::optional<double> spectral_radius, growth_per_second;
  /// of a body that is not linear, or touches something
  std::optional<SceneLimit> scene;
  std::string label() const;
};

struct StabilityResult {
  std::vector<StabilityRow> rows;
  std::vector<std::string> left_out;  ///< methods that there was no time for
  bool stopped = false;               ///< by the caller, before all was done
};

/// How far a search is.
struct StabilityProgress {
  std::string doing;
  std::size_t done = 0, of = 0;  ///< methods
  const StabilityResult* so_far = nullptr;
  bool new_row = false;  ///< since the last call
};

/// Called before and after every method and during it; false stops the search.
using StabilityWatch = std::function<bool(const StabilityProgress&)>;

/// The largest stable macro step of each method, by bisection on runs beside the one predicted
/// before. Small motions: about rest, linearised, without loads and contact, see small_motion.hpp.
/// Predicted is, of a level alone, what its set-up says; of cycle him, the limit of the inertia
/// that it has at its own macro step, 2 / sqrt(lambda); of the other cycles, the step at which the
/// spectral radius of their map exceeds 1 by more than such a run can detect.
/// @param options  its methods (empty: all, explicit integrators on coarser levels too), variants,
/// duration, budget, and the first precision InputError for bad options or problems; methods that
/// refuse are rows. Kokkos must be initialised.
StabilityResult stability(const Problem& problem, const StudyOptions& options,
                          const StabilityWatch& watch = {});

}  // namespace plica
