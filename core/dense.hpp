// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <vector>

// Dense algebra on the host with the processor's vector instructions, for what is factorised while
// a simulation runs. Matrices are symmetric, n numbers by n.
namespace plica::dense {

/// The inverse of a positive definite matrix, in place. False where it is not positive definite:
/// then A is of no use.
bool invert(int n, double* A);

/// K phi = s M phi for K of 3n x 3n numbers and a positive semi-definite M of n x n, which stands
/// for M times the 3x3 unit matrix. Left out are combinations whose M is below 1e-8 of what it is
/// for their parts. The eigenvalues s, ascending, and the vectors phi [3n], one after the other,
/// with phi . M phi = 1; how many there are is returned.
/// @param s    [3n]
/// @param phi  [3n x 3n]
int modes(int n, const double* K, const double* M, double* s, double* phi);

/// sum over k < count of s_k phi_k phi_k^T, for vectors of n numbers that stand one after the
/// other.
void recompose(int n, int count, const double* s, const double* phi, double* A);

/// The lower half of A += B^T B, for B of `rows` by n numbers, column by column.
void add_gram(int rows, int n, const double* B, double* A);

/// The largest eigenvalue of a Lanczos iteration's tridiagonal matrix, and how far it can be from
/// one of the operator's.
struct RitzBound {
  double value = 0;
  double residual = 0;
};

/// @param diagonal  at least one
/// @param beside    one less
/// @param next      what would stand beside the next one
RitzBound largest_ritz_bound(const std::vector<double>& diagonal, const std::vector<double>& beside,
                             double next);

/// The same for an iteration that goes on until it knows enough.
class LargestRitz {
 public:
  /// @param tolerance  of the residual, as a part of the value
  explicit LargestRitz(double tolerance) : tolerance_(tolerance) {}

  /// The next step's entry on the diagonal and the one beside it. True where that is enough, or
  /// nothing can follow.
  bool add(double diagonal, double next);

  /// The eigenvalue with its residual: on the sure side.
  double bound() const { return bound_; }

 private:
  double tolerance_, bound_ = 0, next_ = 0;
  std::vector<double> diagonal_, beside_;
  std::size_t look_at_ = 5;  // entries, then at each; less often the more there are
};

}  // namespace plica::dense
