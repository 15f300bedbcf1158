// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/drivers/solver/spaces/block_rows.hpp>
#include <vector>

namespace plica {

/// A mesh without the freedom that slivers give it: their stiffest vertices follow their neighbours.
struct SliverSpace {
  RowMatrix up;           ///< [vertices x kept]: mostly the identity
  std::vector<int> kept;  ///< the vertices that stay free, and those whose motion is given; ascending
  double before = 0;      ///< the largest lambda_a over the median, see sliver_space()
  double after = 0;       ///< the same of the kept ones
};

/// lambda_a = lambda_max(K_aa) / m_a says how stiff a vertex is for its mass; of a mesh of tetrahedra the largest eigenvalue of
/// M^-1 K is between the largest lambda_a and four times that. Slivers raise it for a few vertices, and these shorten the
/// stable step of all. Vertices above 3.5 times the median follow a linear fit of their neighbours, the stiffest first, no
/// two neighbours in a round; K and m become those of the vertices that are left (Galerkin), and it is looked again, at most twelve times
/// and up to 35 % of the vertices. None where there is no such vertex.
/// @param constrained  per vertex: its motion is given, it stays
/// @param mass         per vertex [kg]
/// @param K            the mesh's stiffness; used up
std::optional<SliverSpace> sliver_space(const TetMesh& mesh, const std::vector<char>& constrained,
                                        std::vector<double> mass, BlockRows K);

}  // namespace plica
