// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/elastic/largest_eigenvalue.hpp>
#include <plica/drivers/methods/integrators.hpp>

namespace plica {

/// Range of Rayleigh damping in a level.
struct DampingLimit {
  double least_mass = 0, most_mass = 0;            ///< minimum and maximum mass damping [1/s]
  double least_stiffness = 0, most_stiffness = 0;  ///< minimum and maximum stiffness damping [s]
};

/// Returns the largest stable step of an explicit integrator [s], see StabilityLimit. It is
/// infinite for a free rigid level. Contact does not enter: it is implicit in the step, see
/// cmake/docs/explanation/contact.md.
/// @param K           stiffness of the elements, without damping
/// @param eigenvalue  largest_eigenvalue() of K [1/s^2]
/// @param beside      upper bound of the other contributions to w^2 [1/s^2]
template <class B>
double critical_step(const typename B::Exec& exec, const StiffnessAt<B>& K,
                     const StabilityLimit& limit, const DampingLimit& damping, double eigenvalue,
                     double beside = 0);

}  // namespace plica
