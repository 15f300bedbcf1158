// SPDX-License-Identifier: BSD-3-Clause
#include <plica/kernels/elastic/elastic_blocks.hpp>

namespace plica {

#define PLICA_INSTANTIATE(Real, Exec) PLICA_ELASTIC_BLOCKS(, Backend<Real, Exec>)
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
