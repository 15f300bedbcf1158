// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/level.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/solver/level_forces.hpp>
#include <plica/drivers/solver/state_archive.hpp>

namespace plica {

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
  /// Takes over the system A at `state`, where `forces` have just been linearised; all of them stay as they are until the
  /// solve. `positive`: with the elements' tangents projected to positive semi-definite ones.
  virtual void prepare(const Exec&, const Level<B>&, const LevelForces<B>&, const State<B>& state,
                       const ImplicitWeights&, bool positive) = 0;
  /// x = A^-1 r, zero where motion is given. Overwrites r.
  virtual SolveOutcome solve(const Exec&, const Vectors<B>& r, const Vectors<B>& x) = 0;
  virtual std::map<std::string, long> counters() const { return {}; }
  /// Device memory of its own.
  virtual std::size_t bytes() const = 0;
  virtual void persist(StateArchive<B>&) {}
};

}  // namespace plica
