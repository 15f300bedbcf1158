// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/core/block_matrix.hpp>

namespace plica {

/// Where the element matrices of Patches go in a block matrix: the pairs (i < j) of a patch's vertices that share a tetrahedron and
/// are not both of given motion.
///
/// * patch p: pairs [first_pair(p), first_pair(p+1)), those from first_shared(p) on in other patches too
/// * pair s: the blocks [first_slot(s), first_turned(s)) of `slot` as they are, then transposed those up to first_slot(s+1)
/// * `upper` and `lower`: the places of blocks (i, j) and (j, i) in the matrix, -1 where that row's motion is given; of a shared pair
///   `upper` is its place among the shares
/// * shared block b: the sum of shares [first_share(b), first_share(b+1)), for `shared_upper` and `shared_lower`
///
/// In a patch and among the shared ones or the others, pairs of equally many blocks follow each other.
template <class B>
struct PatchPairs {
  using Memory = typename B::Memory;
  int shares = 0;  ///< in all shared blocks
  Indices<B> first_pair, first_shared;
  Indices<B> first_slot;
  Indices<B> first_turned;
  Kokkos::View<std::uint16_t*, Memory> slot;  ///< offset of a block among the patch's element blocks
  Indices<B> upper, lower;
  Indices<B> first_share;
  Indices<B> shared_upper, shared_lower;
};

}  // namespace plica
