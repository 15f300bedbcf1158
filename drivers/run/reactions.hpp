// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/reports.hpp>
#include <plica/drivers/body/supports.hpp>
#include <plica/drivers/level/level.hpp>
#include <utility>
#include <vector>

namespace plica {

/// Forces that hold the vertices of body.fixed and body.prescribed, on level 0. Its arrays are made
/// when somebody asks for the first time.
template <class B>
class Reactions {
 public:
  /// Makes the forces of some sets, whose centres are placed.
  explicit Reactions(std::vector<HeldSet> sets) : sets_(std::move(sets)) {}

  /// Returns the force and moment of each set on the body, at the level's state at a time [s]. One
  /// pass over the elements; waits. `rest`: places of the vertices at rest [m]. `moves`: false for
  /// a body that seeks equilibrium, where given motions have no inertia.
  std::vector<Reaction> at(Level<B>& level, const Vectors<B>& rest, double time, bool moves);

 private:
  struct Set {
    Indices<B> vertex;
    Indices<B> place;  ///< [vertices] number of each vertex in `vertex`; -1: not held by the set
    Kokkos::View<double* [9], Kokkos::LayoutRight, typename B::Memory> share;
  };
  std::vector<HeldSet> sets_;
  std::vector<Set> held_;  ///< [sets]
  Vectors<B> force_;
  BlockSums<B> blocks_;
  Doubles<B> result_;

  void make_arrays(const Level<B>& level);
};

}  // namespace plica
