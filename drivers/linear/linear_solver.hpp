// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/level.hpp>
#include <plica/core/problem.hpp>
#include <plica/core/state_archive.hpp>
#include <plica/drivers/level/solver_level.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <vector>

namespace plica {

/// Of the coarsest level of multigrid, which is answered by a dense inverse.
inline constexpr int most_dense_unknowns = 1536;

/// What a linear solver is given at set-up, no `auto` left in its options.
struct LinearSolverParts {
  ImplicitOptions options;
  /// from the body's coarser meshes, finest first; for multigrid only
  std::vector<RowMatrix> transfers;
  std::string material;  ///< its name
};

/// How a linear solve ended.
struct SolveOutcome {
  int iterations = 0;
  double relative_residual = 0;
  bool converged = false;
  bool indefinite = false;  ///< met a direction without positive curvature
};

/// Solves the systems of one level's implicit stages.
template <class B>
class LinearSolver {
 public:
  using Exec = typename B::Exec;
  virtual ~LinearSolver() = default;
  /// Takes over the system A of a level at `state`, where its forces have just been linearised; all
  /// of them stay as they are until the solve. `positive`: with the elements' tangents projected to
  /// positive semi-definite ones.
  virtual void prepare(const SolverLevel<B>& level, const State<B>& state, const ImplicitWeights&,
                       bool positive) = 0;
  /// q = A p, where there is a matrix with all of A in it; else false, and nothing is done.
  virtual bool multiply(const Exec&, const Vectors<B>& /*p*/, const Vectors<B>& /*q*/) const {
    return false;
  }
  /// x = A^-1 r, zero where motion is given, until |r - A x| is `tolerance` of |r|, where it
  /// iterates so far. Overwrites r.
  virtual SolveOutcome solve(const Exec&, const Vectors<B>& r, const Vectors<B>& x,
                             double tolerance) = 0;
  /// Whether a solve ends where what is left is small enough, and not after a fixed amount of work.
  virtual bool converges() const { return true; }
  virtual std::map<std::string, long> counters() const { return {}; }
  /// Device memory of its own.
  virtual std::size_t bytes() const = 0;
  virtual void persist(StateArchive<B>&) {}
};

}  // namespace plica
