// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <vector>

namespace plica {

/// The frequency [Hz] at which a body let go in this shape (largest amplitude [m]) moves: from the falling zero crossings of its
/// most displaced vertex along its displacement, over so many periods of about 1/guess. Runs in double on the host; throws
/// std::runtime_error where the run fails.
double frequency_of_motion(const Problem& problem, const std::vector<Point>& shape, double amplitude, int periods,
                           double guess);

}  // namespace plica
