// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/time_functions.hpp>
#include <plica/drivers/loads/dead_loads.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>

namespace plica {

template <class B>
void DeadLoads<B>::add_force(const Exec& exec, const State<B>&, double time, const Vectors<B>& f) {
  for (const Load<B>& load : loads_) add_load<B>(exec, load, load_factor(load.course, time), f);
}

#define PLICA_INSTANTIATE(Real, Exec) template class DeadLoads<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
