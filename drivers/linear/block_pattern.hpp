// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <plica/core/model.hpp>
#include <vector>

namespace plica {

/// Which blocks a level's matrix has, and where its elements go in it.
///
/// An element has six blocks, one for every two of its vertices. Those of a patch's elements are
/// added up where the patch works, and leave it once per pair of vertices. A pair that no other
/// patch has goes straight to the matrix; one that several have goes to the shares, which are added
/// up in the order of the patches:
///
///   elements of a patch    (1,2) of e0   (1,2) of e1        (2,5) of e1   (2,5) of e2
///                               \_________/                      \_________/
///   pairs of the patch             (1,2)                            (2,5)           other patches: (2,5)  (2,5)
///                                    |                                 \__________________  ________/______/
///   matrix                 blocks (1,2) and (2,1)                       blocks (2,5) and (5,2): the sum of the shares
///
/// So every number is a sum in an order that depends on the mesh alone, whatever the number of
/// threads.
template <class B>
struct BlockPattern {
  BlockMatrix<B> matrix;  ///< its values zero
  PatchPairs<B> pairs;
};

/// Rows of vertices with a zero inverse mass have their own block alone.
template <class B>
BlockPattern<B> block_pattern(const Model<B>& model);

}  // namespace plica
