// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/drivers/solver/elasticity.hpp>
#include <plica/drivers/solver/integrators/list.hpp>

namespace plica {

/// w_max^2 of M^-1 (K + over D) at the state u [1/s^2], D the stiffness that damps, by the Lanczos iteration (Golub & Van Loan,
/// 10.1) to a relative residual of 1e-3, which is added: on the sure side. It converges where the power iteration still crawls.
template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const Level<B>& level, const Elasticity<B>& elasticity,
                          const Vectors<B>& u, double over = 0);

/// The range of Rayleigh damping in a level.
struct DampingLimit {
  double least_mass = 0, most_mass = 0;            ///< [1/s]
  double least_stiffness = 0, most_stiffness = 0;  ///< [s]
};

/// The largest stable step of an explicit integrator at the state u [s], see StabilityLimit; infinite for a free rigid level. Contact
/// does not enter: it is implicit in the step, see cmake/docs/contact.md. `beside` bounds what else there is of w^2 [1/s^2].
template <class B>
double critical_step(const typename B::Exec& exec, const Level<B>& level, const Elasticity<B>& elasticity,
                     const Vectors<B>& u, const StabilityLimit& limit, const DampingLimit& damping, double beside = 0);

}  // namespace plica
