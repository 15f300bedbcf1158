// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <optional>
#include <plica/drivers/solver/linear/krylov.hpp>
#include <plica/drivers/solver/linear/linear_solver.hpp>
#include <plica/drivers/solver/linear/preconditioners.hpp>

namespace plica {

/// Conjugate gradients, with or without a matrix, and any preconditioner. A preconditioner that is costly to fit is kept from step to step. It is fitted
/// again when the stage's weights change, or when solves took `patience` iterations more than its first solve needed for the same
/// number of digits, which is about what fitting costs. Solves to a residual start from a guess by the last solutions.
struct ConjugateGradients {
  static constexpr const char* name = "conjugate_gradients";
  static constexpr const char* summary = "preconditioned, with or without a matrix";
  static constexpr int patience = 8;

  template <class B>
  class Of final : public LinearSolver<B> {
   public:
    using Exec = typename B::Exec;

    Of(const Level<B>& level, const LinearSolverParts& parts)
        : options_(parts.options),
          system_(level, parts.options.matrix == "assembled"),
          krylov_(level.model.vertices),
          preconditioner_(make_preconditioner<B>(parts, system_)) {
      if (options_.iterations == 0) last_.emplace(level.model.vertices);
    }

    void prepare(const SolverLevel<B>& level, const State<B>& state, const ImplicitWeights& weights,
                 bool positive) override {
      const Exec& exec = level.exec();
      system_.prepare(level, state, weights, positive);
      if (restored_ && fitted_) preconditioner_->refit(exec);
      restored_ = false;
      if (!preconditioner_ || (fitted_ && weights.a == a_ && weights.b == b_ && spent_ < patience)) return;
      system_.fit(exec, *preconditioner_);
      fitted_ = 1, a_ = weights.a, b_ = weights.b, per_decade_ = spent_ = 0, ++fits_;
    }

    bool multiply(const Exec& exec, const Vectors<B>& p, const Vectors<B>& q) const override {
      if (!system_.by_matrix_alone()) return false;
      system_.product(exec, p, q);
      return true;
    }

    SolveOutcome solve(const Exec& exec, const Vectors<B>& r, const Vectors<B>& x) override {
      const KrylovOutcome out =
          krylov_.solve(exec, system_, preconditioner_.get(), last_ ? &*last_ : nullptr, options_, r, x);
      if (last_ && out.converged) last_->add(exec, x);
      if (per_decade_ == 0 && out.decades > 1) per_decade_ = out.iterations / out.decades;
      if (per_decade_ > 0 && out.decades > 1) spent_ += std::max(0.0, out.iterations - per_decade_ * out.decades);
      if (!out.converged && options_.iterations == 0) spent_ = patience;
      return out;
    }

    std::map<std::string, long> counters() const override {
      if (!preconditioner_) return {};
      return {{"preconditioner_fits", fits_}};
    }
    std::size_t bytes() const override {
      return system_.bytes() + krylov_.bytes() + (last_ ? last_->bytes() : 0) +
             (preconditioner_ ? preconditioner_->bytes() : 0);
    }
    void persist(StateArchive<B>& archive) override {
      if (last_) last_->persist(archive);
      if (!preconditioner_) return;
      for (long* count : {&fitted_, &fits_}) archive.number(*count);
      for (double* value : {&a_, &b_, &per_decade_, &spent_}) archive.number(*value);
      preconditioner_->persist(archive);
      restored_ = archive.restoring();
    }

   private:
    ImplicitOptions options_;
    StageSystem<B> system_;
    Krylov<B> krylov_;
    std::unique_ptr<Preconditioner<B>> preconditioner_;  ///< none: the vertex blocks
    std::optional<LastSolutions<B>> last_;
    long fitted_ = 0, fits_ = 0;
    double a_ = 0, b_ = 0, per_decade_ = 0, spent_ = 0;
    bool restored_ = false;
  };
};

}  // namespace plica
