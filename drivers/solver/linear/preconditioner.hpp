// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/block_matrix.hpp>
#include <plica/drivers/solver/state_archive.hpp>
#include <plica/kernels/implicit/system_kernels.hpp>

namespace plica {

/// z = C r with a symmetric positive definite C near the inverse of a matrix. Vertices whose motion is given get 0.
template <class B>
class Preconditioner {
 public:
  using Exec = typename B::Exec;
  virtual ~Preconditioner() = default;
  /// Fits it to a matrix. `inverse_diagonal`: its vertex blocks' inverses, 0 where the motion is given.
  virtual void fit(const Exec& exec, const BlockMatrix<B>& A, const Blocks<B>& inverse_diagonal) = 0;
  virtual void apply(const Exec& exec, const Vectors<B>& r, const Vectors<B>& z) const = 0;
  virtual std::size_t bytes() const = 0;
  /// Names what it has been fitted to; where that has been restored, refit() makes the rest of it.
  virtual void persist(StateArchive<B>& archive) = 0;
  virtual void refit(const Exec& exec) = 0;
};

}  // namespace plica
