// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <memory>
#include <plica/drivers/level/integrator.hpp>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/methods/integrators.hpp>

namespace plica {

/// Arguments of an integrator's constructor.
template <class B>
struct IntegratorParts {
  ImplicitOptions implicit;
  bool contact = false;     ///< whether the problem has contact
  bool may_invert = false;  ///< whether elements of the material may invert
  bool stops = false;       ///< whether the run ends where a step is not solved
  bool conserves = false;   ///< whether the integrator conserves energy on the linear problem
  /// mean edge length of the level's mesh [m]
  double edge = 0;
  /// makes the linear solver, for implicit integrators
  std::function<std::unique_ptr<LinearSolver<B>>()> make_linear_solver;
  /// part of the forces that may be unbalanced at rest, see RestOptions; 0: the level moves
  double rest = 0;
  double critical_step = 0;  ///< critical step of symplectic Euler, where `rest` is above 0 [s]
};

/// Instantiates Kind::make() for a backend, which is the last argument. It is used in the source
/// that defines Kind::make().
#define PLICA_MAKE_INTEGRATOR(Kind, ...)                        \
  template std::unique_ptr<Integrator<__VA_ARGS__>> Kind::make( \
      const LevelData<__VA_ARGS__>&, const IntegratorParts<__VA_ARGS__>&);

}  // namespace plica
