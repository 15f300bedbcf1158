// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/linear/multigrid_parts.hpp>
#include <plica/drivers/linear/rows_of_sums.hpp>

namespace plica {

template <class B>
CoarseMatrix<B> coarse_matrix(const HostPattern& A, const RowMatrix& P) {
  const RowsOfSums<B> AP = right_product<B>(A, P, {0, A.rows()});
  const RowsOfSums<B> half = left_product<B>(RowMatrix(P.transpose()), {AP.first, AP.column});
  CoarseMatrix<B> made;
  made.pattern = both_halves(half.first, half.column);
  made.matrix = block_matrix<B>("multigrid", made.pattern);
  made.map = {AP.terms, half.terms, unset<Blocks9<B>>("plica::galerkin.between", AP.column.size())};
  return made;
}

#define PLICA_INSTANTIATE(Real, Exec)                                            \
  template CoarseMatrix<Backend<Real, Exec>> coarse_matrix<Backend<Real, Exec>>( \
      const HostPattern&, const RowMatrix&);
PLICA_FOR_EACH_PRECISION(PLICA_INSTANTIATE)

}  // namespace plica
