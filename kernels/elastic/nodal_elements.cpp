// SPDX-License-Identifier: BSD-3-Clause
#include <plica/kernels/elastic/nodal_diagonal.hpp>

namespace plica {

#define PLICA_INSTANTIATE(Real, Exec)         \
  PLICA_NODAL_ROWS(, Backend<Real, Exec>)     \
  PLICA_NODAL_ELEMENTS(, Backend<Real, Exec>) \
  PLICA_NODAL_DIAGONAL(, Backend<Real, Exec>)
PLICA_FOR_EACH_PRECISION(PLICA_INSTANTIATE)

}  // namespace plica
