// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/archive.hpp>
#include <plica/kernels/contact/pair_tree.hpp>

namespace plica {

/// Finds the parts of a level's surface that are near each other, and fills the slots of pairs.
/// All work is in kernels. Lists of what may come near are reused until something has moved far.
template <class B>
class PairSearch {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  PairSearch(const PairLimits<Real>& limits, const ContactRecords<B>& records,
             const EmbeddedSurface<B>& surface);
  /// Fills the slots of pairs at a state. `fresh`: no last step is known.
  void find(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& state,
            const ContactRecords<B>& records, bool fresh, const BlockSums<B>& blocks) const;
  void name_fields(Archive<B>& archive) const { archive.owns(own_); }

 private:
  PairTree<B> own_, tree_;  ///< own_ owns the arrays; tree_ is the copy for kernels

  void bound(const Exec& exec, const ContactRecords<B>& records) const;
};

}  // namespace plica
