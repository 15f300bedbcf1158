// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/type_list.hpp>
#include <plica/drivers/solver/integrators/bdf2.hpp>
#include <plica/drivers/solver/integrators/central_difference.hpp>
#include <plica/drivers/solver/integrators/forward_euler.hpp>
#include <plica/drivers/solver/integrators/generalized_alpha.hpp>
#include <plica/drivers/solver/integrators/implicit_euler.hpp>
#include <plica/drivers/solver/integrators/newmark.hpp>
#include <plica/drivers/solver/integrators/rk2.hpp>
#include <plica/drivers/solver/integrators/rk4.hpp>
#include <plica/drivers/solver/integrators/symplectic_euler.hpp>
#include <plica/drivers/solver/integrators/v_cycle_euler.hpp>

namespace plica {

/// Every integrator there is. One more: its file above, its name here.
using Integrators = TypeList<SymplecticEuler, CentralDifference, ForwardEuler, Rk2, Rk4, ImplicitEuler, Newmark, Bdf2,
                             GeneralizedAlpha, VCycleEuler>;

}  // namespace plica
