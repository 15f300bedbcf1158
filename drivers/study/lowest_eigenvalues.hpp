// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace plica {

/// The `count` lowest eigenvalues of a symmetric positive definite A of that size, ascending, from products with its inverse:
/// Lanczos' iteration, orthogonalised in full (Golub & Van Loan, Matrix Computations, 10.3), to relative residuals of 1e-9. Of a
/// multiple eigenvalue it may miss copies.
std::vector<double> lowest_eigenvalues(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& inverse,
                                       Eigen::Index size, int count);

}  // namespace plica
