// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <vector>

// Dense algebra on the host, with the processor's vector instructions. It is for matrices that are
// factorised while a simulation runs. Matrices are symmetric, [n][n].
namespace plica::dense {

/// Inverts a positive definite matrix in place; its lower half is read. Returns false, and leaves A
/// as it is, where A is not positive definite or its lower half is not finite.
[[nodiscard]] bool invert(int n, double* A);

/// Solves K phi = s M phi for K, 3n x 3n, and a positive semi-definite M, n x n. M stands for M
/// times the 3x3 unit matrix. Combinations whose M is below 1e-8 of what it is for their parts are
/// left out. The eigenvalues s ascend. The vectors phi [3n] stand one after the other, with phi . M
/// phi = 1. Returns the number of modes.
/// @param s    [3n]
/// @param phi  [3n x 3n]
int modes(int n, const double* K, const double* M, double* s, double* phi);

/// Computes A = sum over k < count of s_k phi_k phi_k^T. The vectors phi_k have n numbers and stand
/// one after the other.
void recompose(int n, int count, const double* s, const double* phi, double* A);

/// Adds B^T B to the lower half of A. B is `rows` by n numbers, column by column.
void add_gram(int rows, int n, const double* B, double* A);

/// Largest eigenvalue of a Lanczos iteration's tridiagonal matrix, and its error. An eigenvalue of
/// the operator is at most `residual` away.
struct RitzBound {
  double value = 0;
  double residual = 0;
};

/// Computes the bound from the entries of the tridiagonal matrix.
/// @param diagonal  at least one entry
/// @param beside    entries beside the diagonal, one fewer
/// @param next      entry beside the diagonal that would follow
RitzBound largest_ritz_bound(const std::vector<double>& diagonal, const std::vector<double>& beside,
                             double next);

/// Computes a RitzBound along a Lanczos iteration, which goes on until the residual is small
/// enough.
class LargestRitz {
 public:
  /// @param tolerance  maximum residual, as a part of the value
  explicit LargestRitz(double tolerance) : tolerance_(tolerance) {}

  /// Adds the next step's entry on the diagonal and the one beside it. Returns true where the
  /// residual is small enough, or nothing can follow.
  bool add(double diagonal, double next);

  /// Returns the eigenvalue plus its residual, which is on the safe side.
  double bound() const { return bound_; }

 private:
  // part of the eigenvalue below which the next entry may be rounding: where no more directions are
  // left, rounding is blown up by how far motions without stiffness have grown, 1e4 and more. The
  // residual is then below any tolerance
  static constexpr double rounding = 1e-3;
  double tolerance_, bound_ = 0, next_ = 0, largest_ = 0;
  std::vector<double> diagonal_, beside_;
  // number of entries at which the bound is computed next; less often the more there are
  std::size_t look_at_ = 5;
};

}  // namespace plica::dense
