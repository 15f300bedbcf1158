// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <memory>
#include <plica/drivers/level/integrator.hpp>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/methods/integrators.hpp>

namespace plica {

/// What an integrator is given at set-up.
template <class B>
struct IntegratorParts {
  ImplicitOptions implicit;
  bool contact = false;
  /// elements of the material
  bool may_invert = false;
  /// the run, where a step is not solved
  bool stops = false;
  /// energy, on the linear problem
  bool conserves = false;
  /// mean, of the level's mesh [m]
  double edge = 0;
  std::function<std::unique_ptr<LinearSolver<B>>()> make_linear_solver;  ///< for implicit ones
};

/// In the source that defines Kind::make(): compiles it for a backend, which is the last argument.
#define PLICA_MAKE_INTEGRATOR(Kind, ...)                        \
  template std::unique_ptr<Integrator<__VA_ARGS__>> Kind::make( \
      const Level<__VA_ARGS__>&, const IntegratorParts<__VA_ARGS__>&);

}  // namespace plica
