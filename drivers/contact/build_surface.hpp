// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/transfer.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica {

/// Returns one row of weights for each target whose `keep` is not set.
/// A target whose weights are zero gets no row either, and so keeps its own value.
template <class B>
Transfer<B> build_transfer(const std::string& name, const Embedding& embedding,
                           const std::vector<char>& keep);

/// Returns the interpolation of a surface's points from one level's vertices, and its transpose in
/// gather form.
template <class B>
EmbeddedSurface<B> build_surface(const TriangleSurface& surface, const Embedding& embedding);

}  // namespace plica
