// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/pair_grid.hpp>

namespace plica {

/// Finds what of a level's surface is near what else of it: fills the records of pairs. Kernels alone; a grid of the triangles is kept
/// while nothing has moved far, and where nothing is near the lists are left out.
template <class B>
class PairSearch {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  PairSearch(const PairLimits<Real>& limits, const TouchingPoints<B>& points);
  /// Depth, normal, velocity, triangle and weights of each point near one, and the pairs that each point is a corner of.
  void find(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& state, const TouchingPoints<B>& points,
            const BlockSums<B>& blocks) const;
  std::size_t bytes() const;

 private:
  PairGrid<B> grid_;
  BlockSums<B> blocks_;  ///< for triangles
  Indices<B> count_;     ///< [points]

  void make_grid(const Exec& exec, const TouchingPoints<B>& points) const;
  void list_parts(const Exec& exec, const PairedPoints<B>& pairs) const;
};

}  // namespace plica
