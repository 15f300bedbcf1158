// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/drivers/time/critical_step.hpp>

namespace plica {

template <class B>
double critical_step(const typename B::Exec& exec, const StiffnessAt<B>& K,
                     const StabilityLimit& limit, const DampingLimit& damping, double eigenvalue,
                     double beside) {
  const double infinite = std::numeric_limits<double>::infinity();
  const double w = std::sqrt(eigenvalue + beside);
  const double most = damping.most_mass + damping.most_stiffness * w * w;
  const double by_damping = limit.damping > 0 && most > 0 ? limit.damping / most : infinite;
  if (!(w > 0)) return by_damping;
  if (limit.growth > 0) {
    const double least = damping.least_mass + damping.least_stiffness * w * w;
    return std::min(
        std::pow(least / (limit.growth * std::pow(w, limit.power)), 1.0 / (limit.power - 1)),
        by_damping);
  }
  if (limit.radius <= 0) return infinite;
  // Damping acts like the stiffness radius D / h. The limit is where step(h) = h, reached from
  // above. There ln step has a slope of at most 1/2 over ln h, as the eigenvalue is convex in 1/h.
  // The limit is therefore not below step^2 / h.
  double h = limit.radius / w;
  for (int i = 0; i < 20 && damping.most_stiffness > 0; ++i) {
    const double damped =
        largest_eigenvalue<B>(exec, {K.level, K.elasticity, K.u, limit.radius / h}) + beside;
    const double step = limit.radius / std::sqrt(damped);
    const bool close = std::abs(step - h) < 5e-3 * h;
    h = close ? std::min(step, step * step / h) : step;
    if (close) break;
  }
  const double by_mass =
      damping.most_mass > 0 && limit.damping > 0 ? limit.damping / damping.most_mass : infinite;
  return std::min(h, by_mass);
}

#define PLICA_INSTANTIATE(Real, Exec)                                              \
  template double critical_step<Backend<Real, Exec>>(                              \
      const Exec&, const StiffnessAt<Backend<Real, Exec>>&, const StabilityLimit&, \
      const DampingLimit&, double, double);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
