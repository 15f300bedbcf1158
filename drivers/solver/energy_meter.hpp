// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/drivers/solver/hierarchy.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/kernels/reduce.hpp>

namespace plica {

/// Sums level 0's energies, in a fixed order.
template <class B>
class EnergyMeter {
 public:
  EnergyMeter(const Hierarchy<B>& hierarchy, const Point& gravity);
  Energies motion() const;          ///< kinetic and potential only: one pass over the vertices
  Energies all(double time) const;  ///< one more over the elements and the surface

 private:
  const Hierarchy<B>& hierarchy_;
  Vec3<typename B::Real> gravity_;
  BlockSums<B> blocks_;
  Kokkos::View<double*, typename B::Memory> result_;

  std::array<double, 2> read() const;
};

}  // namespace plica
