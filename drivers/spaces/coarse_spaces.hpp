// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/problem.hpp>
#include <plica/drivers/spaces/block_rows.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

// Coarse levels that are made of the finest mesh alone: spaces of motions of its vertices, without
// elements. Steppers and preconditioners that need no coarse elements run on them where a body has
// no coarser meshes.
//
//   vertices of the mesh          all of them, slivers included
//        | sliver_space()         the few that are much too stiff follow their neighbours
//   kept vertices
//        | moving_least_squares() each from the 10 or so points around it
//   points, a quarter of them     spread evenly along the edges: farthest_points()
//        | moving_least_squares()
//   points, 300 of them           the first of these
namespace plica {

/// A mesh without the freedom that slivers give it: their stiffest vertices follow their
/// neighbours.
struct SliverSpace {
  RowMatrix up;  ///< [vertices x kept]: mostly the identity
  /// the vertices that stay free, and those whose motion is given; ascending
  std::vector<int> kept;
  double before = 0;  ///< the largest lambda_a over the median, see sliver_space()
  double after = 0;   ///< the same of the kept ones
};

/// lambda_a = lambda_max(K_aa) / m_a says how stiff a vertex is for its mass; of a mesh of
/// tetrahedra the largest eigenvalue of M^-1 K is between the largest lambda_a and four times that.
/// Slivers raise it for a few vertices, and these shorten the stable step of all. Vertices
/// above 3.5 times the median follow a linear fit of their neighbours, the stiffest first, no two
/// neighbours in a round; K and m become those of the vertices that are left (Galerkin), and it is
/// looked again, at most twelve times and up to 35 % of the vertices. None where there is no such
/// vertex.
/// @param constrained  per vertex: its motion is given, it stays
/// @param mass         per vertex [kg]
/// @param K            the mesh's stiffness; used up
std::optional<SliverSpace> sliver_space(const TetMesh& mesh, const std::vector<char>& constrained,
                                        std::vector<double> mass, BlockRows K);

/// A coarse space, as the next finer one sees it.
struct CoarseSpace {
  /// P: values at its points -> at those of the finer one, [finer points x points]
  RowMatrix up;
  std::vector<int> points;  ///< vertices of the mesh; where these are fixed a space has none
  /// mean distance along edges to the next point; not of a sliver space [m]
  double spacing = 0;
  bool slivers = false;  ///< whether it is a sliver space
};

/// How many points spaces have by themselves.
struct SizeRule {
  double first;           ///< of the free vertices, in the first
  int fewest, most;       ///< in the last; in between are even steps of at most 5
  double last = 1. / 25;  ///< of the free vertices, within these two
  double sparsest = 4;    ///< free vertices to a point of the last, at least
};
inline constexpr SizeRule him_sizes{0.25, 100, 300};
inline constexpr SizeRule him_sizes_with_contact{0.25, 300, 300};  ///< what touches is detail
/// Below meshes: the coarsest one has few vertices already.
inline constexpr SizeRule him_sizes_below_meshes{0.25, 300, 300, 1. / 25, 2};
inline constexpr SizeRule multigrid_sizes{
    0.1, 200, 200};  ///< fewer: its coarse matrices cost more than what they leave to iterate

/// Finest first. None for a mesh of fewer than 120 free vertices.
std::vector<int> space_sizes(int free_vertices, SizeRule rule = him_sizes);
/// Those that are asked for, or these.
/// @param asked        see Body::coarsen
/// @param constrained  per vertex of the mesh: its motion is given
std::vector<int> space_sizes(const std::optional<std::vector<int>>& asked,
                             const std::vector<char>& constrained, SizeRule rule = him_sizes);

struct SpaceOptions {
  std::vector<int> sizes;  ///< numbers of free points, finest first, at least fewest_points each
  double reach = 1.8;      ///< of the transfers' radius over the points' spacing
  bool slivers = false;    ///< a sliver space comes first, where the mesh has slivers
};

/// @param constrained  per vertex: its motion is given
/// @param mass         per vertex [kg]; for slivers only
/// @param K            the mesh's stiffness; for slivers only
std::vector<CoarseSpace> coarse_spaces(const TetMesh& mesh, const std::vector<char>& constrained,
                                       const std::vector<double>& mass, const BlockRows& K,
                                       const SpaceOptions& options);

/// A level's mesh at rest.
struct RestLevel {
  const TetMesh& mesh;
  const std::vector<char>& constrained;  ///< per vertex: its motion is given
  /// the next finer level's vertices in this mesh; none: worked out where it is needed
  const Embedding* up = nullptr;
};

/// What lies below a level.
struct LevelsBelow {
  std::vector<RowMatrix> transfers;  ///< P of each, finest first: values at its vertices or points
                                     ///< -> at those of the one above
  std::vector<CoarseSpace> made;     ///< those of them that are no meshes
};

/// The coarser meshes, and coarse_spaces() of the last mesh where sizes are given. Where asked for,
/// a sliver space stands in front of them.
/// @param levels  meshes, finest first
/// @param smooth  the transfers of meshes: see transfer_matrix()
LevelsBelow levels_below(const std::vector<RestLevel>& levels, const std::vector<double>& mass,
                         const BlockRows& K, const SpaceOptions& options, bool smooth);

/// Whether a body has coarser levels for that cycle, or auto: meshes, or for those that need no
/// elements there a mesh of which spaces can be made.
bool has_coarse_levels(std::string_view cycle, const Body& body);
}  // namespace plica
