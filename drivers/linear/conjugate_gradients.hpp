// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <plica/drivers/linear/krylov.hpp>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/linear/preconditioners.hpp>

namespace plica {

/// Conjugate gradients, with or without a matrix, with any preconditioner.
/// A preconditioner that is costly to fit is kept from step to step. It is fitted again when the
/// stage's weights change, or when solves together took `patience` iterations more than its first
/// solve needed for the same number of digits. That is about the cost of a fit. A solve that
/// multigrid does not finish in `most_cycles` iterations, or in which multigrid is not positive
/// definite, is finished by the vertex blocks alone. After two such solves in a row multigrid is
/// not used any more. This happens with nodal elements of a material that stiffens exponentially,
/// where coarser levels are those of linear elements. Solves to a residual start from a guess by
/// the last solutions.
struct ConjugateGradients {
  static constexpr const char* name = "conjugate_gradients";
  static constexpr const char* summary = "preconditioned, with or without a matrix";
  static constexpr int patience = 8;
  static constexpr int most_cycles = 300;

  template <class B>
  class Of final : public LinearSolver<B> {
   public:
    using Exec = typename B::Exec;

    Of(const LevelData<B>& level, const LinearSolverParts& parts)
        : options_(parts.options),
          system_(level, parts.options.matrix == "assembled", true),
          krylov_(level.model.vertices, ranks_of<B>(level)),
          preconditioner_(make_preconditioner<B>(parts, system_)) {
      if (options_.iterations > 0) return;
      last_.emplace(level.model.vertices);
      if (preconditioner_) rest_ = zeros<Vectors<B>>("plica::cg.rest", level.model.vertices);
    }

    void prepare(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights,
                 bool projected) override {
      const Exec& exec = level.exec();
      system_.prepare(level, state, weights, projected);
      if (restored_ && fitted_) preconditioner_->refit(exec);
      restored_ = false;
      if (!preconditions() || (fitted_ && weights.a == a_ && weights.b == b_ && spent_ < patience))
        return;
      system_.fit(exec, *preconditioner_);
      fitted_ = 1, a_ = weights.a, b_ = weights.b, per_decade_ = spent_ = 0, ++fits_;
    }

    bool multiply(const Exec& exec, const Vectors<B>& p, const Vectors<B>& q) const override {
      if (!system_.by_matrix_alone() || system_.composes()) return false;
      system_.product(exec, p, q);
      return true;
    }

    SolveOutcome solve(const Exec& exec, const Vectors<B>& r, const Vectors<B>& x,
                       double tolerance) override {
      const LastSolutions<B>* const last = last_ ? &*last_ : nullptr;
      ImplicitOptions options = options_;
      options.relative_residual = tolerance;
      if (!preconditions())
        return accept_state(exec, krylov_.solve(exec, system_, nullptr, last, options, r, x), x);
      if (options.preconditioner == MultigridCycle::name)
        options.max_iterations = std::min(options.max_iterations, most_cycles);
      const KrylovOutcome out =
          krylov_.solve(exec, system_, preconditioner_.get(), last, options, r, x);
      if (per_decade_ == 0 && out.decades > 1) per_decade_ = out.iterations / out.decades;
      if (per_decade_ > 0 && out.decades > 1)
        spent_ += std::max(0.0, out.iterations - per_decade_ * out.decades);
      const bool gives_up = !out.converged && !out.indefinite && options.iterations == 0 &&
                            std::isfinite(out.relative_residual);
      given_up_ = gives_up ? given_up_ + 1 : 0;
      if (!gives_up) return accept_state(exec, out, x);
      spent_ = patience;
      return accept_state(exec, finish(exec, out, r, x, tolerance), x);
    }

    bool converges() const override { return options_.iterations == 0; }
    bool reads_kept() const override { return system_.reads_kept(); }

    std::map<std::string, long> counters() const override {
      if (!preconditioner_) return {};
      return {{"preconditioner_fits", fits_}, {"preconditioner_given_up", preconditions() ? 0 : 1}};
    }
    void name_fields(Archive<B>& archive) override {
      system_.name_fields(archive), krylov_.name_fields(archive);
      if (last_) last_->name_fields(archive);
      if (!preconditioner_) return;
      for (long* count : {&fitted_, &fits_, &given_up_}) archive.number(*count);
      for (double* value : {&a_, &b_, &per_decade_, &spent_}) archive.number(*value);
      preconditioner_->name_fields(archive);
      archive.owns(rest_);
      restored_ = restored_ || archive.restoring();
    }

   private:
    ImplicitOptions options_;
    StageSystem<B> system_;
    Krylov<B> krylov_;
    std::unique_ptr<Preconditioner<B>> preconditioner_;  ///< null: the vertex blocks
    std::optional<LastSolutions<B>> last_;
    /// part of a solution that is found after the preconditioner has given up
    Vectors<B> rest_;
    long fitted_ = 0, fits_ = 0, given_up_ = 0;  ///< given_up_: number of solves in a row
    double a_ = 0, b_ = 0, per_decade_ = 0, spent_ = 0;
    bool restored_ = false;

    bool preconditions() const { return preconditioner_ && given_up_ < 2; }

    SolveOutcome accept_state(const Exec& exec, const KrylovOutcome& out, const Vectors<B>& x) {
      if (last_ && out.converged) last_->add(exec, x);
      return out;
    }

    /// Finishes a solve from x with the residual r, by the vertex blocks alone.
    KrylovOutcome finish(const Exec& exec, const KrylovOutcome& before, const Vectors<B>& r,
                         const Vectors<B>& x, double tolerance) {
      const double left = before.relative_residual;
      ImplicitOptions options = options_;
      options.relative_residual = std::min(1.0, tolerance / left);
      KrylovOutcome out = krylov_.solve(exec, system_, nullptr, nullptr, options, r, rest_);
      add<B>(exec, "plica::cg_rest", 1, rest_, x);
      out.iterations += before.iterations, out.relative_residual *= left;
      return out;
    }
  };
};

}  // namespace plica
