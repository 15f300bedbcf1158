// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/drivers/solver/integrators/conjugate_gradients.hpp>
#include <plica/drivers/solver/integrators/integrator.hpp>
#include <plica/kernels/motion/prescribe.hpp>

namespace plica {

/// Backward Euler, linearly implicit (one Newton iteration: Baraff & Witkin 1998) or iterated: order 1, dissipative, no
/// stability limit on the step for the linear problem. Contact is in the solve, predicted in the first iteration.
struct ImplicitEuler {
  static constexpr const char* name = "implicit_euler";
  static constexpr const char* summary = "implicit, order 1, dissipative; linearly implicit, or by Newton's method";
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{0.0};

  template <class B>
  class Step final : public Integrator<B> {
   public:
    Step(const Level<B>& level, const IntegratorOptions& options)
        : options_(options),
          at_start_("implicit.start", level.model.vertices),
          cg_(level.model.vertices),
          blocks_(level.model.vertices) {}

    void advance(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h,
                 int steps) override {
      residual_ = 0;
      for (int s = 0; s < steps; ++s) {
        prescribe(exec, level, level.state, time + s * h, h);
        at_start_.copy(exec, level.state);
        double first = 0;
        for (int i = 0; i < std::max(1, options_.implicit.newton_iterations); ++i) {
          const double size = iterate(exec, level, forces, time + s * h, h, i == 0);
          if (i == 0) first = size;
          if (size <= options_.implicit.newton_tolerance * first && i > 0) break;
        }
        prescribe(exec, level, level.state, time + (s + 1) * h);
      }
    }

    std::map<std::string, long> counters() const override {
      return {{"linear_solves", solves_},
              {"cg_iterations", iterations_},
              {"cg_misses", misses_},
              {"cg_indefinite", indefinite_}};
    }
    std::size_t bytes() const override {  // two states' worth of vectors at the start, five and the blocks in the solve
      return (6 + 15 + 6) * sizeof(typename B::Real) * at_start_.u.extent(0);
    }
    double residual() const override { return residual_; }
    void persist(StateArchive<B>& archive) override {
      for (long* count : {&solves_, &iterations_, &misses_, &indefinite_}) archive.number(*count);
      archive.number(residual_);
    }

   private:
    IntegratorOptions options_;
    State<B> at_start_;
    CgVectors<B> cg_;
    BlockSums<B> blocks_;
    long solves_ = 0, iterations_ = 0, misses_ = 0, indefinite_ = 0;
    double residual_ = 0;

    /// One Newton iteration; returns |b| in the preconditioner's norm.
    double iterate(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h,
                   bool first) {
      using Real = typename B::Real;
      const int n = level.model.vertices;
      const double inertia = 1 + h * options_.mass_damping;
      const ImplicitOptions& o = options_.implicit;
      // later iterations linearise about the predicted end, where time has passed and contact needs no prediction
      forces.linearise(level, level.state, first ? time : time + h, h, first ? h : 0, level.f);
      forces.preconditioner(level, level.state, h, inertia, cg_.preconditioner);
      if (first) forces.tangent(level, level.state, level.state.v);
      update_vertices<B>(exec, "plica::newton_right_side", n,
                         NewtonRightSide<B>{level.model, at_start_.v, level.state.v, level.f, level.partial, cg_.r,
                                            static_cast<Real>(h), static_cast<Real>(options_.mass_damping), first});
      CgOutcome out;
      forces.book("solve", [&] {
        out = conjugate_gradients<B>(
            exec, cg_, blocks_, n, o.relative_residual, o.iterations, o.max_iterations,
            [&](const Vectors<B>& p, const Vectors<B>& q) { forces.product(level, level.state, p, h, inertia, q); });
      });
      count(out);
      update_vertices<B>(exec, "plica::newton_update", n,
                         NewtonUpdate<B>{at_start_.u, cg_.x, level.state.u, level.state.v, static_cast<Real>(h)});
      return out.right_side;
    }

    void count(const CgOutcome& out) {
      ++solves_, iterations_ += out.iterations;
      misses_ += out.converged ? 0 : 1, indefinite_ += out.indefinite ? 1 : 0;
      residual_ = std::max(residual_, out.relative_residual);
    }
  };
};

}  // namespace plica
