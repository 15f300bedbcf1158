// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/core/reports.hpp>
#include <plica/core/transfer.hpp>
#include <plica/meshes/embedding.hpp>
#include <string>
#include <vector>

namespace plica {

/// Returns the density of each region of a mesh [kg/m^3]; one entry where it names none.
std::vector<double> region_densities(const Body& body, const TetMesh& mesh);

/// Returns the mass of each vertex: a quarter of the mass of each of its tetrahedra [kg]. A vertex
/// that follows others has given its mass to these, by weight, and has none.
std::vector<double> lumped_masses(const TetMesh& mesh, const std::vector<double>& density);

/// Returns the report of each piece of a mesh, the finest first; none for a mesh without pieces.
std::vector<PieceReport> piece_reports(const TetMesh& mesh, const std::vector<double>& density);

/// Returns the masses of a coarse level's vertices, restricted from the finer level: m = P^T
/// m_fine. A vertex that gets none keeps the mass of its own elements (`own`), and all are scaled
/// to the total.
/// @param up       embedding of the finer vertices in the coarse mesh, without negative weights
/// @param without  number of vertices that get no mass from the finer level
std::vector<double> inherited_masses(const Embedding& up, const std::vector<double>& fine,
                                     const std::vector<double>& own, int& without);

/// Rows of a restriction on the host, see Restriction.
struct RestrictionRow {
  std::vector<int> source;              ///< finer vertices, ascending
  std::vector<double> weight, average;  ///< [source]
};

/// Returns the adjoint of `up`, a row for each coarse vertex. A coarse vertex without a finer one
/// in its elements averages the finer element it lies in (`down`).
std::vector<RestrictionRow> restriction_rows(const Embedding& up, const std::vector<double>& fine,
                                             const Embedding& down);
template <class B>
Restriction<B> build_restriction(const std::vector<RestrictionRow>& rows);

}  // namespace plica
