// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>

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

/// Brackets the step at which stable(step) turns false nearest to the guess, then bisects its logarithm.
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

}  // namespace plica
