// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/cycles/him/him_body.hpp>
#include <plica/drivers/cycles/stepper.hpp>

// Symbols of cmake/docs/explanation/him.md: A is HimParts::inverse_mass, gamma, b and alpha are in
// HimParts::fit.
namespace plica {

/// Makes the data of `him` for each body, without the fit.
/// Levels and spaces of the bodies are added to the reports.
template <class B>
std::vector<HimParts<B>> him_parts(StepperSetup<B>& setup);

/// Fits all bodies to the scene's macro step, or to the longest automatic step that fits all.
/// Throws InputError where a given step does not fit.
/// @param usual  becomes the automatic step that was tried first; 0 where the step was given [s]
/// @return       the macro step [s]
template <class B>
double fit_step(const StepperSetup<B>& setup, std::vector<HimParts<B>>& bodies, double& usual);

/// Fits all bodies to the scene's macro step. Returns false where one does not fit; then all have
/// the largest weights, which are not stable.
template <class B>
bool fit_given_step(const StepperSetup<B>& setup, std::vector<HimParts<B>>& bodies);

/// Completes the reports with the results of the fits.
template <class B>
void report_fits(StepperSetup<B>& setup, const std::vector<HimParts<B>>& bodies);

}  // namespace plica
