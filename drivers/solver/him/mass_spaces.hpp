// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <plica/drivers/solver/spaces/transfer_matrix.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

namespace plica {

/// The coarsest level's linear problem K phi = w^2 M phi at rest, and the inverse mass of its modes.
class CoarseModes {
 public:
  static constexpr Eigen::Index most_modes = 1200;     ///< computed; larger levels use the matrix of implicit Euler
  static constexpr Eigen::Index most_unknowns = 4500;  ///< of a dense matrix

  /// [3 vertices x 3 vertices] each; vertices without mass have the identity in M.
  CoarseModes(Eigen::MatrixXd K, Eigen::MatrixXd M);

  /// S = Phi s Phi^T [1/kg]. With all modes s = min(sinc^2(w t / 2), kappa / (w t)^2), beyond w t = pi only the latter: leapfrog
  /// then has the exact frequency of each mode below, and none is faster than kappa allows. Else (M + t^2 K / kappa)^-1.
  Eigen::MatrixXd answer(double t, double kappa) const;

  /// The largest t^2 w^2 s, at most kappa.
  double largest(double t, double kappa) const;

 private:
  Eigen::MatrixXd K_, M_, modes_;  // K and M only without the modes
  Eigen::VectorXd squares_;        // w^2 [1/s^2]
};

/// A coarser level as a space of motions of the finest mesh.
struct MassSpace {
  RowMatrix up;                          ///< P, [finer level's vertices x vertices]
  RowMatrix mass;                        ///< M = P^T (the finer level's M) P [kg]
  std::vector<double> inverse_diagonal;  ///< of D = sum of |M| along a row [1/kg]; 0: no motion here
};

/// A level's mesh, which of its vertices have a given motion, and the next finer level's vertices in it.
struct MassMesh {
  const TetMesh& mesh;
  const std::vector<char>& constrained;
  const Embedding& up;  ///< extrapolated outside; of the finest level not looked at
};

/// The coarser levels' spaces, finest first. Transfers are the embeddings, smoothed on the finer mesh where asked for. Vertices whose motion is given have no part in them.
/// @param mass  of the finest level's vertices [kg]
std::vector<MassSpace> mass_spaces(const std::vector<MassMesh>& levels, const std::vector<double>& mass, bool smooth);

/// The product of all transfers: the coarsest level's space in the finest mesh.
RowMatrix to_finest(const std::vector<MassSpace>& spaces);

/// K = Pi^T (the rest stiffness of the finest mesh) Pi, [3 vertices x 3 vertices], xyz interleaved [N/m].
/// @param lame  per region of the mesh [Pa]
Eigen::MatrixXd coarse_stiffness(const TetMesh& finest, const std::vector<std::array<double, 2>>& lame,
                                 const RowMatrix& to_finest);

}  // namespace plica
