// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <plica/drivers/solver/energy_meter.hpp>
#include <plica/kernels/energies.hpp>

namespace plica {

template <class B>
EnergyMeter<B>::EnergyMeter(const Hierarchy<B>& hierarchy, const Point& gravity)
    : hierarchy_(hierarchy), result_("plica::energies", 2) {
  for (int k = 0; k < 3; ++k) gravity_[k] = static_cast<typename B::Real>(gravity[k]);
  const Level<B>& level = hierarchy[0].level;
  blocks_ =
      BlockSums<B>(std::max({level.model.vertices, static_cast<int>(level.partial.extent(0)), level.surface.points}));
}

template <class B>
std::array<double, 2> EnergyMeter<B>::read() const {
  const auto host = Kokkos::create_mirror_view(Kokkos::HostSpace(), result_);
  Kokkos::deep_copy(hierarchy_.exec(), host, result_);
  hierarchy_.exec().fence("plica::energies");
  return {host(0), host(1)};
}

template <class B>
Energies EnergyMeter<B>::motion() const {
  const Level<B>& level = hierarchy_[0].level;
  reduce<B, 2>(hierarchy_.exec(), "plica::motion_energies", level.model.vertices,
               MotionEnergies<B>{level.model.mass, level.state, gravity_}, blocks_, result_);
  const auto sums = read();
  return {sums[0], 0, sums[1], 0};
}

template <class B>
Energies EnergyMeter<B>::all(double time) const {
  const auto& exec = hierarchy_.exec();
  const HierarchyLevel<B>& part = hierarchy_[0];
  Energies e = motion();
  part.forces->elasticity().energy(exec, part.level.model.patches, part.level.state.u, part.level.partial);
  reduce<B, 1>(exec, "plica::elastic_energy", static_cast<int>(part.level.partial.extent(0)),
               FirstComponent<B>{part.level.partial}, blocks_, result_);
  e.elastic = read()[0];
  if (part.forces->contact()) e.contact = part.forces->contact()->energy(exec, part.level, time, blocks_);
  return e;
}

#define PLICA_INSTANTIATE(Real, Exec) template class EnergyMeter<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
