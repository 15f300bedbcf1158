// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/SparseCholesky>
#include <cmath>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/linear/stage_system.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Direct solver: factorises the assembled matrix on the host.
/// The factors are L D L^T with a fill-reducing order (Eigen's SimplicialLDLT). The order and the
/// pattern of L are kept from the first solve. For small systems, where the host can read the
/// matrix.
struct Direct {
  static constexpr const char* name = "direct";
  static constexpr const char* summary =
      "L D L^T of the assembled matrix, on the host; for small systems";

  template <class B>
  class Of final : public LinearSolver<B> {
   public:
    using Exec = typename B::Exec;
    using Matrix = Eigen::SparseMatrix<double>;

    Of(const LevelData<B>& level, const LinearSolverParts& parts)
        : system_(level, true), projects_(parts.options.tangent == "auto") {}

    void prepare(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights,
                 bool projected) override {
      factorise(level, state, weights, projected);
      if (projected || !projects_ || !indefinite()) return;
      factorise(level, state, weights, true);  // an indefinite A may raise the energy
      ++projected_;
    }

    SolveOutcome solve(const Exec& exec, const Vectors<B>& r, const Vectors<B>& x,
                       double) override {
      fence(exec, "plica::direct");
      const int n = 3 * system_.rows();
      Eigen::VectorXd b(n);
      for (int i = 0; i < n; ++i) b[i] = static_cast<double>(r(i / 3, i % 3));
      SolveOutcome out;
      const double size = b.norm();
      if (size == 0) b.setZero();
      const Eigen::VectorXd answer =
          factor_.info() == Eigen::Success ? Eigen::VectorXd(factor_.solve(b)) : b;
      for (int i = 0; i < n; ++i) x(i / 3, i % 3) = static_cast<typename B::Real>(answer[i]);
      out.indefinite = indefinite();
      out.relative_residual =
          size > 0 ? (b - lower_.template selfadjointView<Eigen::Lower>() * answer).norm() / size
                   : 0.0;
      out.converged = factor_.info() == Eigen::Success && std::isfinite(out.relative_residual);
      return out;
    }

    std::map<std::string, long> counters() const override {
      return {{"projected_systems", projected_}};
    }
    void name_fields(Archive<B>& archive) override {
      archive.number(projected_);
      system_.name_fields(archive);
    }

   private:
    StageSystem<B> system_;
    bool projects_;
    long projected_ = 0;
    Matrix lower_;
    /// [values of lower_] block of the matrix that has the value, and the number in the block; a
    /// negative block: the value is 1
    std::vector<std::pair<int, int>> entries_;
    Eigen::SimplicialLDLT<Matrix> factor_;

    /// Returns true where a row has more than its own block.
    /// A vertex whose motion is given has only its own block, and its column is left out.
    static bool coupled(const BlockMatrix<B>& A, int a) { return A.first(a + 1) - A.first(a) > 1; }

    /// Returns true where a row of T^T A T is empty, see StageSystem::composes(): its vertex does
    /// not move, or follows others.
    bool is_empty(int a) const {
      return system_.composes() && system_.inverse_diagonal()(a, 0) == 0;
    }

    bool indefinite() const {
      return factor_.info() == Eigen::Success && (factor_.vectorD().array() < 0).any();
    }

    void factorise(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights,
                   bool projected) {
      const Exec& exec = level.exec();
      system_.prepare(level, state, weights, projected);
      const BlockMatrix<B>& A = system_.matrix(exec);
      fence(exec, "plica::direct");
      if (lower_.rows() == 0) analyse(A);
      double* value = lower_.valuePtr();
      for (const auto& [block, entry] : entries_)
        *value++ = block < 0 ? 1.0 : static_cast<double>(A.value(block, entry));
      factor_.factorize(lower_);
    }

    void analyse(const BlockMatrix<B>& A) {
      std::vector<Eigen::Triplet<double, int>> triplets;
      for (int a = 0; a < A.rows; ++a)
        for (int s = A.diagonal(a); s < A.first(a + 1); ++s)  // column a, by symmetry
          for (int k = 0; k < 9 && (A.column(s) == a || coupled(A, A.column(s))); ++k)
            if (is_empty(a)) {
              if (k % 4 == 0) triplets.emplace_back(3 * a + k / 3, 3 * a + k / 3, -1.0);
            } else if (3 * A.column(s) + k / 3 >= 3 * a + k % 3)
              triplets.emplace_back(3 * A.column(s) + k / 3, 3 * a + k % 3,
                                    static_cast<double>(9 * A.place(s) + k));
      lower_.resize(3 * A.rows, 3 * A.rows);
      lower_.setFromTriplets(triplets.begin(), triplets.end());
      lower_.makeCompressed();
      for (Eigen::Index i = 0; i < lower_.nonZeros(); ++i) {
        const auto place = static_cast<int>(lower_.valuePtr()[i]);
        entries_.emplace_back(place < 0 ? -1 : place / 9, place < 0 ? 0 : place % 9);
      }
      factor_.analyzePattern(lower_);
    }
  };
};

}  // namespace plica
