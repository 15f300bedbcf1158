// SPDX-License-Identifier: BSD-3-Clause
#include <Spectra/SymEigsSolver.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <plica/drivers/study/eigenvalues.hpp>
#include <stdexcept>

namespace plica {

namespace {

constexpr double close_enough = 1e-9;
constexpr Eigen::Index most_restarts = 300, least_space = 20;

/// Product in the form that Spectra expects.
class Operation {
 public:
  using Scalar = double;
  Operation(const Product& product, Eigen::Index size) : product_(product), size_(size) {}
  Eigen::Index rows() const { return size_; }
  Eigen::Index cols() const { return size_; }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, size_) = product_(Eigen::Map<const Eigen::VectorXd>(x, size_));
  }

 private:
  const Product& product_;
  Eigen::Index size_;
};

/// Returns the `count` largest eigenvalues, descending; count < size.
Eigen::VectorXd largest_by_lanczos(const Product& product, Eigen::Index size, Eigen::Index count) {
  Operation operation(product, size);
  const Eigen::Index space = std::min(size, std::max(least_space, 3 * count));
  Spectra::SymEigsSolver<Operation> solver(operation, count, space);
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, most_restarts, close_enough);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw std::runtime_error("Lanczos' iteration does not find the " + std::to_string(count) +
                             " lowest eigenvalues");
  return solver.eigenvalues();
}

}  // namespace

RitzValue largest_ritz_value(const Product& map, const Eigen::VectorXd& start,
                             Eigen::Index dimension) {
  const Eigen::Index m = std::min(dimension, start.size());
  Eigen::MatrixXd Q(start.size(), m), H = Eigen::MatrixXd::Zero(m, m);
  Q.col(0) = start.normalized();
  Eigen::Index used = 0;
  double beyond = 0;
  while (used < m) {
    Eigen::VectorXd w = map(Q.col(used));
    const double size = w.norm();
    const auto basis = Q.leftCols(used + 1);
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd h = basis.transpose() * w;
      H.col(used).head(used + 1) += h;
      w -= basis * h;
    }
    beyond = w.norm();
    ++used;
    if (used == m || !(beyond > 10 * std::numeric_limits<double>::epsilon() * size)) break;
    H(used, used - 1) = beyond;
    Q.col(used) = w / beyond;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> small(H.topLeftCorner(used, used));
  Eigen::Index largest = 0;
  small.eigenvalues().cwiseAbs().maxCoeff(&largest);
  const std::complex<double> value = small.eigenvalues()[largest];
  const Eigen::VectorXcd y = small.eigenvectors().col(largest);
  const double of_it = std::abs(value) * y.norm();
  return {value, of_it > 0 ? beyond * std::abs(y[used - 1]) / of_it : 0};
}

std::vector<double> lowest_eigenvalues(const Product& inverse, Eigen::Index size, int count) {
  Eigen::VectorXd largest;
  if (count < size) {
    largest = largest_by_lanczos(inverse, size, count);
  } else {
    Eigen::MatrixXd A(size, size);
    for (Eigen::Index j = 0; j < size; ++j) A.col(j) = inverse(Eigen::VectorXd::Unit(size, j));
    largest = symmetric_eigenvalues(A).reverse();
  }
  std::vector<double> list;
  for (const double value : largest) list.push_back(1 / value);
  return list;
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

double spectral_radius(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace plica
