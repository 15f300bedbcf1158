// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <plica/drivers/solver/linear/krylov.hpp>
#include <plica/drivers/solver/linear/linear_solver.hpp>
#include <plica/drivers/solver/linear/preconditioners.hpp>

namespace plica {

/// Solves each system by one V-cycle, x = C r. A matrix is assembled only where the cycle is fitted: when the stage's weights change, when
/// the residual after the cycle has grown to `worn` times that of its first solve, and in every step in which contact may begin. In exact
/// arithmetic C A has its eigenvalues in (0, 1], as long as C is the cycle of this A.
struct VCycleSolver {
  static constexpr const char* name = "v_cycle";
  static constexpr const char* summary = "one V-cycle of multigrid per system, at any residual";
  static constexpr double worn = 1.5;

  template <class B>
  class Of final : public LinearSolver<B> {
   public:
    using Exec = typename B::Exec;

    Of(const Level<B>& level, const LinearSolverParts& parts)
        : system_(level, false),
          cycle_(MultigridCycle::template make<B>(parts, system_)),
          product_(zeros<Vectors<B>>("plica::v_cycle.product", level.model.vertices)),
          scaled_(zeros<Vectors<B>>("plica::v_cycle.scaled", level.model.vertices)),
          squares_(zeros<Doubles<B>>("plica::v_cycle.squares", 2)),
          sums_(level.model.vertices) {}

    void prepare(const SolverLevel<B>& level, const State<B>& state, const ImplicitWeights& weights,
                 bool positive) override {
      const Exec& exec = level.exec();
      system_.prepare(level, state, weights, positive);
      if (restored_ && fitted_) cycle_->refit(exec);
      restored_ = false;
      const bool same = weights.a == a_ && weights.b == b_ && !level.contact() && !level.asks_caller();
      if (fitted_ && same && last_ <= worn * first_) return;
      cycle_->fit(exec, system_.matrix(exec), system_.inverse_diagonal());
      fitted_ = 1, a_ = weights.a, b_ = weights.b, first_ = last_ = 0, ++fits_;
    }

    SolveOutcome solve(const Exec& exec, const Vectors<B>& r, const Vectors<B>& x) override {
      const auto slot = [&](int k) { return Doubles<B>(squares_.data() + k, 1); };
      const auto square = [&](int k) {
        reduce<B, 1>(exec, "plica::v_cycle_square", system_.rows(), CgSquare<B>{system_.inverse_diagonal(), r, scaled_},
                     sums_, slot(k));
      };
      square(0);
      cycle_->apply(exec, r, x);
      system_.product(exec, x, product_);
      add<B>(exec, "plica::v_cycle_residual", -1, product_, r);
      square(1);
      const std::vector<double> squares = host_values(exec, squares_);
      SolveOutcome out;
      out.iterations = 1;
      out.relative_residual = squares[0] > 0 ? std::sqrt(squares[1] / squares[0]) : 0;
      out.converged = std::isfinite(squares[0]) && std::isfinite(out.relative_residual);
      last_ = out.relative_residual;
      if (first_ == 0) first_ = last_;
      return out;
    }

    std::map<std::string, long> counters() const override { return {{"preconditioner_fits", fits_}}; }
    std::size_t bytes() const override {
      return system_.bytes() + cycle_->bytes() + (product_.span() + scaled_.span()) * sizeof(typename B::Real);
    }
    void persist(StateArchive<B>& archive) override {
      for (long* count : {&fitted_, &fits_}) archive.number(*count);
      for (double* value : {&a_, &b_, &first_, &last_}) archive.number(*value);
      cycle_->persist(archive);
      restored_ = archive.restoring();
    }

   private:
    StageSystem<B> system_;
    std::unique_ptr<Preconditioner<B>> cycle_;
    Vectors<B> product_, scaled_;
    Doubles<B> squares_;
    BlockSums<B> sums_;
    long fitted_ = 0, fits_ = 0;
    double a_ = 0, b_ = 0, first_ = 0, last_ = 0;
    bool restored_ = false;
  };
};

}  // namespace plica
