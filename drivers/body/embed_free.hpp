// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/body/body_parts.hpp>
#include <vector>

namespace plica {

/// Embeds points in tetrahedra of free vertices, so that forces on the points act on vertices that
/// have mass. A point on a vertex that follows others has its masters. A point in a tetrahedron
/// with such a vertex has the nearest tetrahedron that has none, extrapolated. Without vertices
/// that follow others it is BodyLocator::embed().
/// @param mesh    the locator's mesh
/// @param part    per point the number of its body; empty: there is one
Embedding embed_free(const TetMesh& mesh, const std::vector<BodyPart>& parts,
                     const BodyLocator& locator, const std::vector<Point>& points,
                     const std::vector<int>& part);

}  // namespace plica
