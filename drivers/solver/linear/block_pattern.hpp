// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/patch_pairs.hpp>
#include <vector>

namespace plica {

/// Which blocks a level's matrix has, and where its elements go in it.
template <class B>
struct BlockPattern {
  BlockMatrix<B> matrix;  ///< its values zero
  PatchPairs<B> pairs;
};

/// Vertices with a zero inverse mass have their own block alone.
template <class B>
BlockPattern<B> block_pattern(const Model<B>& model);

}  // namespace plica
