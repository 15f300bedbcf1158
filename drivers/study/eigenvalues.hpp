// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <complex>
#include <functional>
#include <vector>

// Eigenvalues of small matrices and of maps that are known by their products. Whatever
// decomposition studies and problems with known answers need is compiled in this one place: in each
// further source it would cost ten seconds and more.
namespace plica {

/// The product of a square matrix with a vector.
using Product = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// An eigenvalue of a map as a Krylov space sees it.
struct RitzValue {
  std::complex<double> value;
  double residual = 0;  ///< |A y - value y| / |value y| of its vector y
};

/// The largest by modulus in the space of start, A start, A^2 start ... of at most `dimension`
/// (Arnoldi 1951, orthogonalised twice); exact where that space holds no more. It does not restart,
/// and returns its residual also where that is large.
RitzValue largest_ritz_value(const Product& map, const Eigen::VectorXd& start,
                             Eigen::Index dimension);

/// The `count` lowest eigenvalues of a symmetric positive definite A of that size, ascending, from
/// products with its inverse: Lanczos' iteration, restarted (Spectra), to relative residuals of
/// 1e-9. Of a multiple eigenvalue it may miss copies. std::runtime_error where it does not
/// converge.
std::vector<double> lowest_eigenvalues(const Product& inverse, Eigen::Index size, int count);

/// All eigenvalues of a symmetric matrix, ascending.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// The largest modulus of a matrix's eigenvalues.
double spectral_radius(const Eigen::MatrixXd& matrix);

}  // namespace plica
