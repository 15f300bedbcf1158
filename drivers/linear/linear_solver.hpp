// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <plica/core/archive.hpp>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/level_data.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/level/level.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <vector>

namespace plica {

/// Maximum unknowns of the coarsest level of multigrid, which is solved by a dense inverse.
inline constexpr int most_dense_unknowns = 1536;

/// Input of a linear solver at set-up; its options have no `auto`.
struct LinearSolverParts {
  ImplicitOptions options;
  /// transfers from coarser levels, finest first; for multigrid only
  std::vector<RowMatrix> transfers;
  std::string material;  ///< name of the material
};

/// Result of a linear solve, without the solution.
struct SolveOutcome {
  int iterations = 0;
  double relative_residual = 0;
  bool converged = false;
  bool indefinite = false;  ///< true: A has a direction without positive curvature
};

/// Solver of the linear systems of one level's implicit stages.
template <class B>
class LinearSolver {
 public:
  using Exec = typename B::Exec;
  virtual ~LinearSolver() = default;
  /// Sets the system A to that of a level at `state`, where its forces have just been linearised.
  /// Level, state and forces must not change until the solve. `projected`: the tangents of elements
  /// are projected to positive semi-definite ones.
  virtual void prepare(const Level<B>& level, const State<B>& state, const ImplicitWeights&,
                       bool projected) = 0;
  /// Sets q = A p where an assembled matrix has all of A; else does nothing and returns false.
  virtual bool multiply(const Exec&, const Vectors<B>& /*p*/, const Vectors<B>& /*q*/) const {
    return false;
  }
  /// Solves A x = r; x is zero where motion is given. Overwrites r.
  /// A solver that iterates to a residual ends where |r - A x| is `tolerance` of |r|.
  virtual SolveOutcome solve(const Exec&, const Vectors<B>& r, const Vectors<B>& x,
                             double tolerance) = 0;
  /// Returns true where a solve ends at a small residual, false where it does a fixed amount of
  /// work.
  virtual bool converges() const { return true; }
  /// Returns true where products with projected tangents read those that the level keeps, see
  /// Level::keep_tangents().
  virtual bool reads_kept() const { return false; }
  virtual std::map<std::string, long> counters() const { return {}; }
  /// Names the solver's arrays and what it carries from one macro step to the next.
  virtual void name_fields(Archive<B>&) = 0;
};

}  // namespace plica
