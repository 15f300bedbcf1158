// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/drivers/solver/hierarchy.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/kernels/reduce.hpp>

namespace plica {

/// How level 0 moves as a whole, and how fast its fastest vertex moves against that.
struct MotionReport {
  Energies energies;            ///< kinetic and potential alone
  Point drift = Point::Zero();  ///< mean velocity [m/s]
  double edges_per_second = 0;  ///< the largest speed against a given drift, over the edge there [1/s]
};

/// Sums level 0's energies, in a fixed order.
template <class B>
class EnergyMeter {
 public:
  /// `mesh` is that level's.
  EnergyMeter(const Hierarchy<B>& hierarchy, const TetMesh& mesh, const Point& gravity);
  MotionReport motion(const Point& drift) const;  ///< one pass over the vertices
  Energies all(double time) const;                ///< and one over the elements and the surface

 private:
  const Hierarchy<B>& hierarchy_;
  Vec3<typename B::Real> gravity_;
  Scalars<B> inverse_edge_;
  double mass_ = 0;
  BlockSums<B> blocks_;
  Kokkos::View<double*, typename B::Memory> result_;

  std::array<double, 6> read() const;
};

}  // namespace plica
