// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/block_matrix.hpp>
#include <plica/core/galerkin_map.hpp>
#include <plica/drivers/solver/spaces/smoothing.hpp>
#include <string>
#include <vector>

namespace plica {

/// Which blocks a matrix has, on the host.
struct HostPattern {
  std::vector<int> first{0}, column;
  int rows() const { return static_cast<int>(first.size()) - 1; }
};

template <class B>
struct CoarseMatrix {
  HostPattern pattern;
  BlockMatrix<B> matrix;  ///< P^T A P, its values zero
  GalerkinMap<B> map;
};

template <class B>
HostPattern host_pattern(const BlockMatrix<B>& A);
template <class B>
BlockMatrix<B> block_matrix(const std::string& name, const HostPattern& pattern);

/// The pattern of P^T A P, own blocks always in it, and how its blocks follow from A's.
template <class B>
CoarseMatrix<B> coarse_matrix(const HostPattern& A, const RowMatrix& P);

}  // namespace plica
