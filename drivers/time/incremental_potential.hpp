// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>

namespace plica {

/// Incremental potential of a stage, at a state that Newton's method visits. It is the sum for
/// inertia, elements, pressures that follow the body, and contact. Its gradient is R, and the stage
/// solves the balance R = 0.
struct IncrementalPotential {
  double value = 0;     ///< [J]
  double residual = 0;  ///< |R| [N]
  double slope = 0;     ///< R.change [J]
  double scale = 0;     ///< sum of the sizes of the terms of `value`, for its rounding [J]
  /// sum of the sizes of three kinds of forces: those that accelerate the body, those that do not
  /// depend on its state, and contact's [N]
  double forces = 0;
  double masses = 0;    ///< root of the sum of the squared masses [kg]
  double volume = 0;    ///< least volume ratio of an element, 1 at most
  bool solved = false;  ///< whether the state solves the stage
  /// Returns the potential with that of contact beside it.
  /// @param energy  of contact, not below 0 [J]
  IncrementalPotential beside(double energy) const {
    IncrementalPotential sum = *this;
    sum.value += energy, sum.scale += energy;
    return sum;
  }
  /// Returns whether `value` and `residual` are finite.
  bool finite() const { return std::isfinite(value) && std::isfinite(residual); }
};

}  // namespace plica
