// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cmath>

#include "support/level_probe.hpp"

// Direct solvers on the same mesh and the same kernels, for what the integrators should come to.
namespace plica::test {

/// K of the free degrees of freedom at rest, from the tangent kernel: a column for each.
class SparseStiffness {
 public:
  explicit SparseStiffness(LevelProbe<Host>& probe) : free_(probe.free()), mass_(probe.mass()) {
    const auto n = static_cast<Eigen::Index>(free_.size());
    std::vector<Eigen::Index> row_of(3 * mass_.size(), -1);
    for (Eigen::Index r = 0; r < n; ++r) row_of[static_cast<std::size_t>(dof(r))] = r;
    std::vector<Eigen::Triplet<double>> entries;
    const auto rest = probe.zero();
    auto p = rest;
    for (Eigen::Index j = 0; j < n; ++j) {
      p[static_cast<std::size_t>(dof(j) / 3)][dof(j) % 3] = 1;
      const auto column = probe.stiffness(rest, p);
      p[static_cast<std::size_t>(dof(j) / 3)][dof(j) % 3] = 0;
      for (std::size_t a = 0; a < column.size(); ++a)
        for (int k = 0; k < 3; ++k)
          if (const Eigen::Index r = row_of[3 * a + static_cast<std::size_t>(k)]; r >= 0 && column[a][k] != 0)
            entries.emplace_back(r, j, column[a][k]);
    }
    matrix_.resize(n, n);
    matrix_.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(matrix_);
  }

  /// The displacement in equilibrium with these forces [N].
  std::vector<Point> equilibrium(const std::vector<Point>& force) const {
    Eigen::VectorXd b(matrix_.rows());
    for (Eigen::Index r = 0; r < b.size(); ++r) b[r] = force[static_cast<std::size_t>(dof(r) / 3)][dof(r) % 3];
    return field(solver_.solve(b));
  }

  /// Frequency [Hz] and shape of the lowest mode, by inverse iteration from a start that has a part in it.
  double lowest_frequency(std::vector<Point>& shape) const {
    Eigen::VectorXd m(matrix_.rows()), x(matrix_.rows());
    for (Eigen::Index r = 0; r < m.size(); ++r) {
      m[r] = mass_[static_cast<std::size_t>(dof(r) / 3)];
      x[r] = shape[static_cast<std::size_t>(dof(r) / 3)][dof(r) % 3];
    }
    double w2 = 0;
    for (int i = 0; i < 200; ++i) {
      const Eigen::VectorXd y = solver_.solve(Eigen::VectorXd(m.cwiseProduct(x)));
      const double next = x.dot(m.cwiseProduct(x)) / x.dot(m.cwiseProduct(y));
      x = y / y.norm();
      if (std::abs(next - w2) < 1e-12 * next) break;
      w2 = next;
    }
    shape = field(x / x.cwiseAbs().maxCoeff());
    return std::sqrt(w2) / (2 * M_PI);
  }

 private:
  std::vector<int> free_;
  std::vector<double> mass_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;

  int dof(Eigen::Index r) const { return free_[static_cast<std::size_t>(r)]; }
  std::vector<Point> field(const Eigen::VectorXd& x) const {
    std::vector<Point> f(mass_.size(), Point::Zero());
    for (Eigen::Index r = 0; r < x.size(); ++r) f[static_cast<std::size_t>(dof(r) / 3)][dof(r) % 3] = x[r];
    return f;
  }
};

}  // namespace plica::test
