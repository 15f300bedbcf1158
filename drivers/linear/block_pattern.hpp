// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <plica/core/model.hpp>
#include <plica/drivers/spaces/row_matrix.hpp>
#include <plica/kernels/reduce.hpp>
#include <vector>

namespace plica {

/// Pattern of a level's matrix: its blocks, and the place of each element's blocks in it.
///
/// An element has six blocks, one for every two of its vertices. The kernel of a patch sums the
/// blocks of its elements, and writes one block per pair of vertices. A pair that no other patch
/// has goes straight to the matrix. A pair of several patches goes to the shares, which are summed
/// in the order of the patches:
///
///   elements of a patch    (1,2) of e0   (1,2) of e1        (2,5) of e1   (2,5) of e2
///                               \_________/                      \_________/
///   pairs of the patch             (1,2)                            (2,5)     other patches: (2,5)
///                                    |                                 \____________  ________/
///   matrix                 blocks (1,2) and (2,1)     blocks (2,5) and (5,2): sum of the shares
///
/// So every number is a sum in an order that depends on the mesh alone, for any number of threads.
template <class B>
struct BlockPattern {
  BlockMatrix<B> matrix;  ///< matrix with all values 0
  PatchPairs<B> pairs;
};

/// Returns the pattern of a model's matrix.
/// A row of a vertex with a zero inverse mass has only its own block, unless it follows others. So
/// has the row of a vertex that another rank owns.
/// @param rows  vertices, and which of them this process owns
template <class B>
BlockPattern<B> block_pattern(const Model<B>& model, const Items& rows);

/// Returns T, [vertices x vertices]: u = T y is the motion of all vertices from that of those which
/// forces move. Vertices whose motion is given have an empty row and column, followers an empty
/// column.
template <class B>
RowMatrix motion_of_free(const Model<B>& model);

}  // namespace plica
