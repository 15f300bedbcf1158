// SPDX-License-Identifier: BSD-3-Clause
// Compiles Eigen under another namespace name. Everywhere else Eigen is as in a program that is
// built without -march: its objects may pass between this library and its callers. There memory has
// the alignment, and functions the code, of such a program. Here Eigen uses vector instructions and
// aligns memory for them. Under one name the linker would use one version of a function for both.
#undef EIGEN_DONT_VECTORIZE
#undef EIGEN_MAX_ALIGN_BYTES
#undef EIGEN_MAX_STATIC_ALIGN_BYTES
#define EIGEN_DONT_PARALLELIZE  // gives the same bits for any number of threads
#define Eigen plica_dense_eigen
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored \
    "-Wmaybe-uninitialized"  // false positives in GCC's own vector intrinsics
#endif
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <plica/core/dense.hpp>

namespace plica::dense {

namespace {

using Matrix = Eigen::MatrixXd;
Eigen::Map<Matrix> matrix(int n, double* A) { return {A, n, n}; }
Eigen::Map<const Matrix> matrix(int n, const double* A) { return {A, n, n}; }

}  // namespace

bool invert(int n, double* A) {
  const Eigen::LLT<Matrix> factor(matrix(n, A));
  // a factor of NaN or infinity counts as a success
  if (factor.info() != Eigen::Success || !factor.matrixLLT().diagonal().allFinite()) return false;
  matrix(n, A).setIdentity();
  factor.solveInPlace(matrix(n, A));
  return true;
}

int modes(int n, const double* K, const double* M, double* s, double* phi) {
  constexpr double least = 1e-8;
  // T: a basis in which M is the unit matrix
  const Eigen::VectorXd diagonal = matrix(n, M).diagonal();
  const Eigen::VectorXd scale = (diagonal.array() > 0).select(diagonal.array().rsqrt(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Matrix> of_mass(scale.asDiagonal() * matrix(n, M) *
                                                      scale.asDiagonal());
  const auto small = (of_mass.eigenvalues().array() < least).count();
  const Eigen::Index kept = n - small;
  const Matrix T = scale.asDiagonal() * of_mass.eigenvectors().rightCols(kept) *
                   of_mass.eigenvalues().tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
  Matrix T3 = Matrix::Zero(3 * n, 3 * kept);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < kept; ++j)
      T3.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(T(i, j));
  const Matrix KT = matrix(3 * n, K) * T3;
  const Eigen::SelfAdjointEigenSolver<Matrix> of_stiffness(T3.transpose() * KT);
  Eigen::Map<Eigen::VectorXd>(s, 3 * kept) = of_stiffness.eigenvalues();
  Eigen::Map<Matrix>(phi, 3 * n, 3 * kept).noalias() = T3 * of_stiffness.eigenvectors();
  return static_cast<int>(3 * kept);
}

void recompose(int n, int count, const double* s, const double* phi, double* A) {
  const Eigen::Map<const Matrix> vectors(phi, n, count);
  matrix(n, A).noalias() =
      vectors * Eigen::Map<const Eigen::VectorXd>(s, count).asDiagonal() * vectors.transpose();
}

void add_gram(int rows, int n, const double* B, double* A) {
  matrix(n, A).selfadjointView<Eigen::Lower>().rankUpdate(
      Eigen::Map<const Matrix>(B, rows, n).transpose());
}

RitzBound largest_ritz_bound(const std::vector<double>& diagonal, const std::vector<double>& beside,
                             double next) {
  const auto vector = [](const std::vector<double>& x) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(vector(diagonal), vector(beside));
  const Eigen::Index last = solver.eigenvalues().size() - 1;
  return {solver.eigenvalues()(last), next * std::abs(solver.eigenvectors()(last, last))};
}

bool LargestRitz::add(double diagonal, double next) {
  if (!diagonal_.empty()) beside_.push_back(next_);
  diagonal_.push_back(diagonal), next_ = next;
  largest_ = std::max(largest_, diagonal);
  const bool last = !(next > std::min(tolerance_, rounding) * largest_);
  const std::size_t steps = diagonal_.size();
  if (!last && steps < look_at_) return false;
  look_at_ = steps + 1 + steps / 16;
  const RitzBound top = largest_ritz_bound(diagonal_, beside_, next);
  bound_ = top.value + top.residual;
  return last || top.residual < tolerance_ * top.value;
}

}  // namespace plica::dense
