// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <plica/core/to_device.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/time/energies.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

template <class B>
EnergyMeter<B>::EnergyMeter(const Hierarchy<B>& hierarchy, const TetMesh& mesh, double mass,
                            const Point& gravity)
    : hierarchy_(hierarchy), mass_(mass), result_("plica::energies", 6) {
  std::vector<double> edges = local_edge_lengths(mesh);
  if (hierarchy[0].ranks) edges = hierarchy[0].ranks->part.local(edges);
  std::vector<typename B::Real> per_edge;
  for (const double edge : edges) per_edge.push_back(static_cast<typename B::Real>(1 / edge));
  inverse_edge_ = to_device<Scalars<B>>("inverse_edge", per_edge);
  set_gravity(gravity);
  const LevelData<B>& level = hierarchy[0];
  blocks_ = BlockSums<B>(std::max(level.model.vertices, level.surface.points), ranks_of<B>(level));
}

template <class B>
void EnergyMeter<B>::set_gravity(const Point& gravity) {
  for (int k = 0; k < 3; ++k) gravity_[k] = static_cast<typename B::Real>(gravity[k]);
}

template <class B>
std::array<double, 6> EnergyMeter<B>::read() const {
  const std::vector<double> sums = host_values(hierarchy_.exec(), result_);
  return {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]};
}

template <class B>
MotionReport EnergyMeter<B>::motion(const Point& drift) const {
  using Term = MotionEnergies<B>;
  const LevelData<B>& level = hierarchy_[0];
  reduce<B, 6, Term, MotionSums>(
      hierarchy_.exec(), "plica::motion_energies", vertices_of<B>(level),
      Term{level.model.mass, level.state, gravity_, inverse_edge_, {drift[0], drift[1], drift[2]}},
      blocks_, result_);
  const auto sums = read();
  const Point mean = Point(sums[2], sums[3], sums[4]) / mass_;
  return {{sums[0], 0, sums[1], 0},
          mean,
          sums[0] - 0.5 * mass_ * mean.squaredNorm(),
          std::sqrt(sums[5])};
}

template <class B>
Energies EnergyMeter<B>::all(double time) const {
  const auto& exec = hierarchy_.exec();
  const Level<B>& level = hierarchy_[0];
  Energies e = motion(Point::Zero()).energies;
  if (level.viscosity) level.viscosity->look_at_once(exec);
  level.elasticity().energy(exec, level, level.state.u);
  complete_shares<B>(exec, level);
  reduce<B, 1>(exec, "plica::elastic_energy", vertices_of<B>(level),
               EnergyOfShares<B>{level.model.shares, level.partial}, blocks_, result_);
  e.elastic = read()[0];
  if (level.contact()) e.contact = level.response().energy(exec, level, time);
  return e;
}

#define PLICA_INSTANTIATE(Real, Exec) template class EnergyMeter<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
