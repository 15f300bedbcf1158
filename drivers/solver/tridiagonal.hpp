// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vector>

namespace plica {

/// The largest eigenvalue of a Lanczos iteration's tridiagonal matrix, and how far it can be from one of the operator's.
struct RitzBound {
  double value = 0;
  double residual = 0;
};

/// @param diagonal  at least one
/// @param beside    one less
/// @param next      what would stand beside the next one
RitzBound largest_ritz_bound(const std::vector<double>& diagonal, const std::vector<double>& beside, double next);

}  // namespace plica
