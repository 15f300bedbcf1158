// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/linear/multigrid.hpp>
#include <plica/drivers/linear/stage_system.hpp>
#include <plica/kernels/linear/krylov.hpp>

namespace plica {

/// Where a solve starts: the best combination of the last few solutions; see
/// kernels/linear/krylov.hpp.
template <class B>
class LastSolutions {
 public:
  using Exec = typename B::Exec;

  explicit LastSolutions(int vertices);
  /// Where there are any: adds the guess to x, which is zero, and takes its part from r.
  void start(const Exec& exec, const StageSystem<B>& system, const BlockSums<B>& sums,
             const Vectors<B>& r, const Vectors<B>& x) const;
  bool any() const { return count_ > 0; }
  /// Takes in a solution, for the oldest.
  void add(const Exec& exec, const Vectors<B>& x);
  std::size_t bytes() const;
  void persist(StateArchive<B>& archive);

 private:
  SolutionSpace<B> space_;
  long count_ = 0;
};

struct KrylovOutcome : SolveOutcome {
  double decades = 0;  ///< by which the iterations have lowered the residual
};

/// Preconditioned conjugate gradients. The residual is measured by sqrt(r . D r), D the inverse
/// vertex blocks, whatever the preconditioner; it is D where there is none of its own. The host
/// looks at the outcome after every iteration where it shares the memory, else after every `watch`:
/// iterations past the end change nothing.
template <class B>
class Krylov {
 public:
  using Exec = typename B::Exec;
  static constexpr int watch = B::on_host ? 1 : 8;

  explicit Krylov(int vertices);
  /// x = A^-1 r from a guess by the last solutions, if any; r becomes the residual.
  /// options.iterations > 0: exactly so many; else until the relative residual, or max_iterations.
  KrylovOutcome solve(const Exec& exec, const StageSystem<B>& system,
                      const Preconditioner<B>* preconditioner, const LastSolutions<B>* last,
                      const ImplicitOptions& options, const Vectors<B>& r,
                      const Vectors<B>& x) const;
  std::size_t bytes() const;

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
