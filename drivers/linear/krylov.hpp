// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/linear/multigrid.hpp>
#include <plica/drivers/linear/stage_system.hpp>
#include <plica/kernels/linear/krylov.hpp>

namespace plica {

/// Initial guess of a solve: the best combination of the last few solutions.
/// See kernels/linear/krylov.hpp.
template <class B>
class LastSolutions {
 public:
  using Exec = typename B::Exec;

  explicit LastSolutions(int vertices);
  /// Adds the guess to x, which is zero, and subtracts A times the guess from r.
  /// Does nothing where there are no solutions yet.
  void start(const Exec& exec, const StageSystem<B>& system, const BlockSums<B>& sums,
             const Vectors<B>& r, const Vectors<B>& x) const;
  bool any() const { return count_ > 0; }
  /// Stores a solution in place of the oldest one.
  void add(const Exec& exec, const Vectors<B>& x);
  void name_fields(Archive<B>& archive);

 private:
  SolutionSpace<B> space_;
  long count_ = 0;
};

struct KrylovOutcome : SolveOutcome {
  double decades = 0;  ///< decimal logarithm of the residual's reduction by the iterations
};

/// Preconditioned conjugate gradients.
/// The residual is measured by sqrt(r . D r) for any preconditioner, D the inverse vertex blocks.
/// Without a preconditioner it is D that preconditions. The host reads the outcome every `watch`
/// iterations: after each one where it shares the memory. Iterations past the end change nothing.
template <class B>
class Krylov {
 public:
  using Exec = typename B::Exec;
  static constexpr int watch = B::on_host ? 1 : 8;

  /// @param ranks  ranks that share the level; null: this process alone
  explicit Krylov(int vertices, Ranks* ranks = nullptr);
  /// Solves A x = r, from a guess by the last solutions, if any; r becomes the residual.
  /// options.iterations > 0: exactly so many iterations; else until the relative residual is
  /// reached, or max_iterations.
  KrylovOutcome solve(const Exec& exec, const StageSystem<B>& system,
                      const Preconditioner<B>* preconditioner, const LastSolutions<B>* last,
                      const ImplicitOptions& options, const Vectors<B>& r,
                      const Vectors<B>& x) const;
  void name_fields(Archive<B>& archive) const { archive.owns(z_, p_, q_, scalars_, sums_.view()); }

 private:
  Vectors<B> z_, p_, q_;
  Doubles<B> scalars_;
  BlockSums<B> sums_;

  Doubles<B> slot(int k) const { return Doubles<B>(scalars_.data() + k, 1); }
  void begin(const Exec& exec, const StageSystem<B>& system, const LastSolutions<B>* last,
             double tolerance, const Vectors<B>& r, const Vectors<B>& x) const;
  void advance(const Exec& exec, const StageSystem<B>& system,
               const Preconditioner<B>* preconditioner, const Vectors<B>& r,
               const Vectors<B>& x) const;
};

}  // namespace plica
