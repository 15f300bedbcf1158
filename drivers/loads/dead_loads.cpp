// SPDX-License-Identifier: BSD-3-Clause
#include <numeric>
#include <plica/core/time_functions.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/loads/dead_loads.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>

namespace plica {

template <class B>
void DeadLoads<B>::add_force(const Exec& exec, const State<B>&, double time, const Vectors<B>& f) {
  for (const Load<B>& load : loads_) add_load<B>(exec, load, load_factor(load.course, time), f);
}

template <class B>
Load<B> weight_load(const std::vector<double>& mass, const Point& gravity,
                    const LoadCourse& course) {
  std::vector<int> vertex(mass.size());
  std::iota(vertex.begin(), vertex.end(), 0);
  std::vector<Point> force;
  for (const double m : mass) force.push_back(m * gravity);
  return {static_cast<int>(force.size()), to_device<Indices<B>>("weight.vertex", vertex),
          to_device<Vectors<B>>("weight.force", rows<typename B::Real>(force)), course};
}

#define PLICA_INSTANTIATE(Real, Exec)                                  \
  template class DeadLoads<Backend<Real, Exec>>;                       \
  template Load<Backend<Real, Exec>> weight_load<Backend<Real, Exec>>( \
      const std::vector<double>&, const Point&, const LoadCourse&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
