// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>

namespace plica {

/// Of inertia, elements, pressures that follow the body, and contact, at a state that Newton's
/// method goes through. Its slope is the balance R = 0 that a stage solves.
struct IncrementalPotential {
  double value = 0;     ///< [J]
  double residual = 0;  ///< |R| [N]
  double slope = 0;     ///< R.change [J]
  double scale = 0;     ///< of what `value` adds up [J]
  /// those that accelerate the body, those that do not depend on its state, and contact's [N]
  double forces = 0;
  double masses = 0;  ///< root of the sum of their squares [kg]
  double volume = 0;  ///< least ratio of an element, or 1
  bool solved = false;
  bool finite() const { return std::isfinite(value) && std::isfinite(residual); }
};

}  // namespace plica
