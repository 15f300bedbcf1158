// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <complex>
#include <functional>
#include <vector>

// Eigenvalues of small matrices and of maps that are known by their products. All decompositions
// that studies and problems with known solutions need are compiled in this one source. Each further
// source would take ten seconds and more to compile.
namespace plica {

/// Product of a square matrix with a vector.
using Product = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// Approximation of a map's eigenvalue in a Krylov space.
struct RitzValue {
  std::complex<double> value;
  double residual = 0;  ///< |A y - value y| / |value y| with the Ritz vector y
};

/// Returns the Ritz value of largest modulus in the space of start, A start, A^2 start ... It is
/// found by Arnoldi's method (1951), orthogonalised twice. The value is exact where the space is
/// invariant. The iteration does not restart, and the residual is returned also where it is large.
/// @param dimension  maximum dimension of the space
RitzValue largest_ritz_value(const Product& map, const Eigen::VectorXd& start,
                             Eigen::Index dimension);

/// Returns the `count` lowest eigenvalues of a symmetric positive definite A, ascending, from
/// products with its inverse. Lanczos' iteration, restarted (Spectra), to relative residuals of
/// 1e-9. It may miss copies of a multiple eigenvalue. Throws std::runtime_error where it does not
/// converge.
/// @param size  number of rows of A
std::vector<double> lowest_eigenvalues(const Product& inverse, Eigen::Index size, int count);

/// Returns all eigenvalues of a symmetric matrix, ascending.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// Returns the largest modulus of a matrix's eigenvalues.
double spectral_radius(const Eigen::MatrixXd& matrix);

}  // namespace plica
