// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/problem.hpp>
#include <plica/drivers/spaces/block_rows.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

// Coarse levels made of the finest mesh alone: spaces of motions of its vertices, without elements.
// Steppers and preconditioners that need no coarse elements use them where a body has no coarser
// meshes.
//
//   vertices of the mesh          all of them, slivers included
//        | sliver_space()         the few vertices that are much too stiff follow neighbours
//   kept vertices
//        | moving_least_squares() each from the 10 or so points around it
//   points, a quarter of them     spread evenly along the edges: farthest_points()
//        | moving_least_squares()
//   points, 300 of them           the first of the points above
namespace plica {

/// Space of the motions of a mesh in which the stiffest vertices of slivers follow their
/// neighbours.
struct SliverSpace {
  RowMatrix up;  ///< [vertices x kept]: mostly the identity
  /// vertices that stay free, and those whose motion is given; ascending
  std::vector<int> kept;
  double before = 0;  ///< largest lambda_a over the median, see sliver_space()
  double after = 0;   ///< largest lambda_a of the kept vertices over the median of all
};

/// Makes the sliver space of a mesh; returns nothing where no vertex is too stiff.
///
/// The stiffness of a vertex for its mass is lambda_a = lambda_max(K_aa) / m_a. In a mesh of
/// tetrahedra the largest eigenvalue of M^-1 K is between the largest lambda_a and four times that.
/// Slivers raise lambda_a for a few vertices, and these shorten the stable step of all. Vertices
/// above 3.5 times the median follow a linear fit of their neighbours, the stiffest first. In one
/// round no two neighbours are removed. Then K and m become those of the remaining vertices
/// (Galerkin), and the next round begins. There are at most twelve rounds, which remove up to 35 %
/// of the vertices.
/// @param constrained  per vertex, nonzero: its motion is given, it stays
/// @param mass         per vertex [kg]
/// @param K            stiffness of the mesh [N/m]; a copy that the elimination changes
std::optional<SliverSpace> sliver_space(const TetMesh& mesh, const std::vector<char>& constrained,
                                        std::vector<double> mass, BlockRows K);

/// Coarse space below a finer one.
struct CoarseSpace {
  /// P: values at the points -> values at the points of the finer space, [finer points x points]
  RowMatrix up;
  std::vector<int> points;  ///< vertices of the mesh, without those whose motion is given
  /// mean distance along edges to the next point; 0 for a sliver space [m]
  double spacing = 0;
  bool slivers = false;  ///< whether it is a sliver space
};

/// Rule for the numbers of points of coarse spaces. The ratio of successive numbers is constant,
/// and 5 at most.
struct SizeRule {
  double first;           ///< points of the first space over free vertices
  int fewest, most;       ///< minimum and maximum number of points of the last space
  double last = 1. / 25;  ///< points of the last space over free vertices, before these limits
  double sparsest = 4;    ///< minimum of free vertices per point, where there is one space only
};
inline constexpr SizeRule him_sizes{0.25, 100, 300};  ///< rule for `him` without contact
/// Rule for `him` with contact: contact needs more detail, so that the last space has 300 points
inline constexpr SizeRule him_sizes_with_contact{0.25, 300, 300};
/// Rule for `him` below coarser meshes: the coarsest mesh has few vertices already
inline constexpr SizeRule him_sizes_below_meshes{0.25, 300, 300, 1. / 25, 2};
/// Rule for multigrid, with fewer points: larger coarse matrices would cost more than the
/// iterations that they save
inline constexpr SizeRule multigrid_sizes{0.1, 200, 200};

/// Returns the numbers of points by a rule, finest first. They are none for a mesh of fewer than
/// 120 free vertices.
std::vector<int> space_sizes(int free_vertices, SizeRule rule = him_sizes);
/// Returns the requested numbers of points, or those by the rule where none are requested.
/// @param asked        requested numbers, see Body::coarsen
/// @param constrained  per vertex of the mesh, nonzero: its motion is given
std::vector<int> space_sizes(const std::optional<std::vector<int>>& asked,
                             const std::vector<char>& constrained, SizeRule rule = him_sizes);

/// Options of coarse_spaces().
struct SpaceOptions {
  std::vector<int> sizes;  ///< numbers of free points, finest first, at least fewest_points each
  double reach = 1.8;      ///< radius of the transfers over the spacing of the points
  bool slivers = false;    ///< whether a sliver space comes first, where the mesh has slivers
};

/// Makes the coarse spaces of a mesh, finest first.
/// @param constrained  per vertex, nonzero: its motion is given
/// @param mass         per vertex [kg]; for slivers only
/// @param K            stiffness of the mesh [N/m]; for slivers only
std::vector<CoarseSpace> coarse_spaces(const TetMesh& mesh, const std::vector<char>& constrained,
                                       const std::vector<double>& mass, const BlockRows& K,
                                       const SpaceOptions& options);

/// Mesh of a level at rest.
struct RestLevel {
  const TetMesh& mesh;
  const std::vector<char>& constrained;  ///< per vertex, nonzero: its motion is given
  /// embedding of the next finer level's vertices in this mesh; null: computed where it is needed
  const Embedding* up = nullptr;
};

/// Levels below the finest one: coarser meshes and coarse spaces.
struct LevelsBelow {
  /// P of each level, finest first: values at its vertices or points -> at those of the level above
  std::vector<RowMatrix> transfers;
  std::vector<CoarseSpace> made;  ///< levels that are coarse spaces
};

/// Makes the transfers to the coarser meshes, and coarse_spaces() of the last mesh where sizes are
/// given. With options.slivers a sliver space of the finest mesh comes first.
/// @param levels  meshes, finest first
/// @param mass    per vertex of the finest mesh [kg]
/// @param K       stiffness of the finest mesh [N/m]
/// @param smooth  whether the transfers of meshes are smoothed, see transfer_matrix()
LevelsBelow levels_below(const std::vector<RestLevel>& levels, const std::vector<double>& mass,
                         const BlockRows& K, const SpaceOptions& options, bool smooth);

/// Returns whether a body has coarser levels for a cycle, or for auto. They are coarser meshes. For
/// cycles that need no coarse elements they may also be coarse spaces, if the mesh is large enough.
bool has_coarse_levels(std::string_view cycle, const Body& body);
}  // namespace plica
