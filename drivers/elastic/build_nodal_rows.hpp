// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/nodal_rows.hpp>
#include <plica/core/rank_part.hpp>
#include <vector>

namespace plica {

/// Constants of nodal elements for each region of a mesh; one entry where the mesh names no region.
struct NodalConstants {
  std::vector<std::vector<double>> material;  ///< constants of the material
  std::vector<double> stabiliser;             ///< beta mu [Pa]
  /// part of lambda that acts on smoothed volumes [Pa]; empty: pressures are not smoothed
  std::vector<double> bulk_excess;
  std::vector<double> damping;  ///< stiffness-proportional damping [s]; empty: none
};

/// Returns the rows of a mesh at rest, one for each domain, by block of vertices, region and
/// vertex. Within short windows of this order rows of similar length are put together.
/// @param given  per vertex: its motion is given; empty: no vertex's is
template <class B>
NodalRows<B> build_nodal_rows(const TetMesh& mesh, const NodalConstants& constants,
                              const std::vector<char>& given = {});

/// Rows of one rank, and the slots that it exchanges.
template <class B>
struct NodalPart {
  NodalRows<B> rows;  ///< rows of owned vertices; slots of other ranks are behind their slots
  HaloRows slots;
};

/// Returns the rows of the vertices that a rank owns; `mesh` has all tetrahedra at these. Slots of
/// other vertices come from their owners: by rank, then by region and vertex.
template <class B>
NodalPart<B> build_nodal_part(const TetMesh& mesh, const NodalConstants& constants,
                              const std::vector<char>& given, const RankPart& part);

/// Allocates the work arrays that kernels over these rows need.
template <class B>
NodalWork<B> make_nodal_work(const NodalRows<B>& rows);

}  // namespace plica
