// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/transfer.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica {

/// Rows for every target whose `keep` is not set; a row of zero weights counts as kept too.
template <class B>
Transfer<B> build_transfer(const std::string& name, const Embedding& embedding,
                           const std::vector<char>& keep);

/// A surface's points in one level, with the transpose in gather form.
template <class B>
EmbeddedSurface<B> build_surface(const TriangleSurface& surface, const Embedding& embedding);

}  // namespace plica
