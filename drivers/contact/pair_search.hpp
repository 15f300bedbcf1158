// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/pair_grid.hpp>

namespace plica {

/// Finds what of a level's surface is near what else of it: fills the slots of pairs. Kernels
/// alone; a grid of the triangles is kept while nothing has moved far.
template <class B>
class PairSearch {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  PairSearch(const PairLimits<Real>& limits, const ContactRecords<B>& records);
  /// The slots of pairs at a state. `fresh`: nothing is known of the last step.
  void find(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& state,
            const ContactRecords<B>& records, bool fresh, const BlockSums<B>& blocks) const;
  std::size_t bytes() const;

 private:
  PairGrid<B> own_, grid_;  ///< grid_: own_ as kernels are given it
  BlockSums<B> blocks_;     ///< for triangles

  void make_grid(const Exec& exec, const ContactRecords<B>& records) const;
};

}  // namespace plica
