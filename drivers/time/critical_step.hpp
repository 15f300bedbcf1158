// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/elastic/largest_eigenvalue.hpp>
#include <plica/drivers/methods/integrators.hpp>

namespace plica {

/// The range of Rayleigh damping in a level.
struct DampingLimit {
  double least_mass = 0, most_mass = 0;            ///< [1/s]
  double least_stiffness = 0, most_stiffness = 0;  ///< [s]
};

/// The largest stable step of an explicit integrator [s], see StabilityLimit; infinite for a free
/// rigid level. Contact does not enter: it is implicit in the step, see cmake/docs/contact.md.
/// @param K           without damping
/// @param eigenvalue  largest_eigenvalue() of it [1/s^2]
/// @param beside      bounds what else there is of w^2 [1/s^2]
template <class B>
double critical_step(const typename B::Exec& exec, const StiffnessAt<B>& K,
                     const StabilityLimit& limit, const DampingLimit& damping, double eigenvalue,
                     double beside = 0);

}  // namespace plica
