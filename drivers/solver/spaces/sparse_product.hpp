// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/spaces/transfer_matrix.hpp>
#include <utility>
#include <vector>

namespace plica {

/// A B by all threads of the host. Every entry is summed in the order of A's columns, with the same bits for any number of threads.
RowMatrix product(const RowMatrix& A, const RowMatrix& B);

/// The matrix of these rows of (column, value), columns ascending.
RowMatrix matrix_of_rows(const std::vector<std::vector<std::pair<int, double>>>& rows, Eigen::Index columns);

}  // namespace plica
