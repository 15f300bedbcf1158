// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <plica/drivers/linear/krylov.hpp>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/linear/preconditioners.hpp>

namespace plica {

/// Solver of each system by one V-cycle, x = C r.
/// A matrix is assembled only where the cycle is fitted. That is when the stage's weights change,
/// and in every step in which contact may begin. It is also when the residual after the cycle is
/// `worn` times that of its first solve; then the system is solved again. In exact arithmetic C A
/// has its eigenvalues in (0, 1], as long as C is the cycle of this A. That needs a positive
/// definite A. So with `tangent: auto` the cycle is fitted to projected elements.
struct VCycleSolver {
  static constexpr const char* name = "v_cycle";
  static constexpr const char* summary = "one V-cycle of multigrid per system, at any residual";
  static constexpr double worn = 1.5;

  template <class B>
  class Of final : public LinearSolver<B> {
   public:
    using Exec = typename B::Exec;

    Of(const LevelData<B>& level, const LinearSolverParts& parts)
        : system_(level, false),
          projects_(parts.options.tangent == "auto"),
          cycle_(MultigridCycle::template make<B>(parts, system_)),
          residual_(zeros<Vectors<B>>("plica::v_cycle.residual", level.model.vertices)),
          scaled_(zeros<Vectors<B>>("plica::v_cycle.scaled", level.model.vertices)),
          squares_(zeros<Doubles<B>>("plica::v_cycle.squares", 2)),
          sums_(level.model.vertices, ranks_of<B>(level)) {}

    bool converges() const override { return false; }
    bool reads_kept() const override { return system_.reads_kept(); }
    void prepare(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights,
                 bool projected) override {
      const Exec& exec = level.exec();
      system_.prepare(level, state, weights, projected);
      if (restored_ && fitted_) cycle_->refit(exec);
      restored_ = false;
      const bool same =
          weights.a == a_ && weights.b == b_ && !level.contact() && !level.asks_caller();
      if (fitted_ && same) return;
      a_ = weights.a, b_ = weights.b;
      fit(exec);
    }

    SolveOutcome solve(const Exec& exec, const Vectors<B>& r, const Vectors<B>& x,
                       double) override {
      double left = cycle(exec, r, x);
      if (first_ > 0 && !(left <= worn * first_)) {
        fit(exec);
        left = cycle(exec, r, x);
      }
      if (first_ == 0) first_ = left;
      return {.iterations = 1, .relative_residual = left, .converged = std::isfinite(left)};
    }

    std::map<std::string, long> counters() const override {
      return {{"preconditioner_fits", fits_}};
    }
    void name_fields(Archive<B>& archive) override {
      for (long* count : {&fitted_, &fits_}) archive.number(*count);
      for (double* value : {&a_, &b_, &first_}) archive.number(*value);
      cycle_->name_fields(archive), system_.name_fields(archive);
      archive.owns(residual_, scaled_, squares_, sums_.view());
      restored_ = restored_ || archive.restoring();
    }

   private:
    StageSystem<B> system_;
    bool projects_;
    std::unique_ptr<Preconditioner<B>> cycle_;
    Vectors<B> residual_, scaled_;
    Doubles<B> squares_;
    BlockSums<B> sums_;
    long fitted_ = 0, fits_ = 0;
    double a_ = 0, b_ = 0;  ///< weights that the cycle is fitted to
    double first_ = 0;      ///< relative residual of the first solve after a fit; 0: none yet
    bool restored_ = false;

    void fit(const Exec& exec) {
      if (projects_) system_.project();
      system_.fit(exec, *cycle_);
      fitted_ = 1, first_ = 0, ++fits_;
    }

    /// Sets x = C r and returns the relative residual of A x = r.
    double cycle(const Exec& exec, const Vectors<B>& r, const Vectors<B>& x) const {
      const auto square = [&](const Vectors<B>& of, int slot) {
        reduce<B, 1>(exec, "plica::v_cycle_square", system_.items(),
                     CgSquare<B>{system_.inverse_diagonal(), of, scaled_}, sums_,
                     Doubles<B>(squares_.data() + slot, 1));
      };
      cycle_->apply(exec, r, x);
      system_.hold(exec, x);
      system_.product(exec, x, residual_);
      add<B>(exec, "plica::v_cycle_residual", -1, r, residual_);
      square(r, 0), square(residual_, 1);
      const std::vector<double> squares = host_values(exec, squares_);
      return squares[0] > 0 ? std::sqrt(squares[1] / squares[0]) : std::sqrt(squares[0]);
    }
  };
};

}  // namespace plica
