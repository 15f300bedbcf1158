// SPDX-License-Identifier: BSD-3-Clause
// Eigen by another name. Everywhere else Eigen is as in a program that is built without -march: its objects may pass between this
// library and its callers, so memory has the alignment, and functions the code, of such a program. Here it uses vector
// instructions and aligns memory for them. Under one name the linker would take either for both.
#undef EIGEN_DONT_VECTORIZE
#undef EIGEN_MAX_ALIGN_BYTES
#undef EIGEN_MAX_STATIC_ALIGN_BYTES
#define EIGEN_DONT_PARALLELIZE  // the same bits for any number of threads
#define Eigen plica_dense_eigen
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // false positives in GCC's own vector intrinsics
#endif
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
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
  if (factor.info() != Eigen::Success) return false;
  matrix(n, A).setIdentity();
  factor.solveInPlace(matrix(n, A));
  return true;
}

void eigenvectors(int n, const double* K, const double* M, double* s, double* phi) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(matrix(n, K), matrix(n, M));
  Eigen::Map<Eigen::VectorXd>(s, n) = solver.eigenvalues();
  matrix(n, phi) = solver.eigenvectors();
}

void recompose(int n, const double* s, const double* phi, double* A) {
  const Eigen::Map<const Matrix> vectors = matrix(n, phi);
  matrix(n, A).noalias() = vectors * Eigen::Map<const Eigen::VectorXd>(s, n).asDiagonal() * vectors.transpose();
}

RitzBound largest_ritz_bound(const std::vector<double>& diagonal, const std::vector<double>& beside, double next) {
  const auto vector = [](const std::vector<double>& x) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(vector(diagonal), vector(beside));
  const Eigen::Index last = solver.eigenvalues().size() - 1;
  return {solver.eigenvalues()(last), next * std::abs(solver.eigenvectors()(last, last))};
}

}  // namespace plica::dense
