// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <plica/drivers/solver/linear/linear_solver.hpp>
#include <string>

namespace plica {

/// What an integrator is given at set-up.
template <class B>
struct IntegratorParts {
  ImplicitOptions implicit;
  std::function<std::unique_ptr<LinearSolver<B>>()> make_linear_solver;  ///< for implicit ones
};

/// One level's ODE solver.
template <class B>
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Takes the level's state through `steps` steps of h from `time` [s]. Contact is found anew in every step.
  virtual void advance(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h,
                       int steps) = 0;
  virtual std::map<std::string, long> counters() const { return {}; }
  /// Device memory of its own.
  virtual std::size_t bytes() const { return 0; }
  /// The largest relative residual that a linear solve of the last advance() ended with; 0 where there are none.
  virtual double residual() const { return 0; }
  /// Why the last advance() cannot be trusted, a sentence for whoever runs it; empty where it can.
  virtual std::string failure() const { return {}; }
  /// The state was replaced: what it carries from the steps before does not belong to it.
  virtual void forget() {}
  /// Names what it carries from one macro step to the next, for saving and restoring.
  virtual void persist(StateArchive<B>&) {}
};

/// The stability limit of an integrator on u'' = -K u - D u' (K and D per mass): the largest h with
/// lambda_max(h^2 K + h radius D) <= radius^2. For symplectic Euler, whose limit is h^2 w^2 + 2 h c <= 4, that is exact; for a
/// Runge-Kutta method it keeps all h s within `radius`. One that grows at every step undamped, |R|^2 = 1 + growth (h w)^power -
/// h c, is stable where damping outweighs that. Implicit: none of this.
struct StabilityLimit {
  double radius = 0;   ///< 0: none of this kind
  double growth = 0;   ///< 0: it does not grow at every step
  int power = 0;       ///< of h w, above 1
  double damping = 0;  ///< the largest h c, where mass damping c is explicit; 0: it is implicit and never a limit
};

}  // namespace plica
