// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/cycles/him/him_body.hpp>
#include <plica/drivers/cycles/stepper.hpp>

namespace plica {

/// Makes what `him` has of each body, but for the fit; its levels and spaces are added to the
/// reports.
template <class B>
std::vector<HimParts<B>> him_parts(StepperSetup<B>& setup);

/// Fits all of them to the scene's macro step, or to the longest automatic one that they bear
/// together. InputError where a given one does not fit.
/// @param usual  takes the automatic step that was tried first; 0 where the step was given [s]
/// @return       the macro step [s]
template <class B>
double fit_step(const StepperSetup<B>& setup, std::vector<HimParts<B>>& bodies, double& usual);

/// Completes the reports by the fits.
template <class B>
void report_fits(StepperSetup<B>& setup, const std::vector<HimParts<B>>& bodies);

}  // namespace plica
