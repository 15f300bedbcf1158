// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/drivers/solver/energy_meter.hpp>
#include <plica/drivers/study/small_motion.hpp>
#include <random>

namespace plica {

namespace {

constexpr double largest_energy_ratio = 10;  // of the last quarter to the first
constexpr double hopeless = 1e12;            // times the energy at the start: nothing bounded gets there
constexpr double amplitude = 1e-6;           // of an edge, per macro step
constexpr double quarters = 0.75;            // of a run, from its first quarter to its last

template <class B>
void start(BuiltHierarchy<B>& built, double t) {
  Hierarchy<B>& hierarchy = *built.hierarchy;
  const Level<B>& level = hierarchy[0].level;
  hierarchy.exec().fence("plica::small_motion");
  const auto inverse = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), level.model.inverse_mass);
  const auto v = Kokkos::create_mirror_view(level.state.v);
  std::mt19937 random(1);
  const double speed = amplitude * built.reports.front().mean_edge / t;
  std::uniform_real_distribution<double> within(-speed, speed);
  for (std::size_t a = 0; a < v.extent(0); ++a)
    for (std::size_t k = 0; k < 3; ++k) v(a, k) = inverse(a) > 0 ? static_cast<typename B::Real>(within(random)) : 0;
  Kokkos::deep_copy(level.state.v, v);
  Kokkos::deep_copy(level.state.u, typename B::Real(0));
  for (auto& part : hierarchy.levels) part.integrator->forget();
  built.cycle->begin(hierarchy);
}

}  // namespace

double visible_growth(double modes, long macro_steps) {
  return std::log(largest_energy_ratio * modes) / (2 * quarters * static_cast<double>(macro_steps));
}

template <class B>
SmallMotion small_motion(BuiltHierarchy<B>& built, double t, const SmallMotionOptions& options) {
  start(built, t);
  Hierarchy<B>& hierarchy = *built.hierarchy;
  const EnergyMeter<B> meter(hierarchy, Point::Zero());
  const long n = options.macro_steps;
  double first = meter.all(0).total(), last = 0;
  const double at_start = first;
  SmallMotion found;
  for (long i = 1; i <= n; ++i) {
    for (auto& part : hierarchy.levels) part.forces->begin_macro_step();
    built.cycle->step(hierarchy, 0, t);
    const double energy = meter.all(0).total();
    if (!(energy <= hopeless * at_start)) return {false, false, std::numeric_limits<double>::infinity()};
    if (4 * i <= n) first = std::max(first, energy);
    if (4 * i > 3 * n) last = std::max(last, energy);
    if (options.go_on && !options.go_on()) return {true, true, 0};
  }
  found.bounded = last <= largest_energy_ratio * first;
  if (last > 0 && first > 0) found.growth = std::log(last / first) / (2 * quarters * static_cast<double>(n));
  return found;
}

#define PLICA_INSTANTIATE(Real, Exec) \
  template SmallMotion small_motion(BuiltHierarchy<Backend<Real, Exec>>&, double, const SmallMotionOptions&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
