// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <vector>

namespace plica {

/// The coarsest level's linear problem K phi = w^2 M phi at rest, and the inverse mass of its
/// modes. What has next to no mass in M, or is nearly a combination of other motions, is left out.
class CoarseModes {
 public:
  /// computed; larger levels use the matrix of implicit Euler
  static constexpr Eigen::Index most_modes = 1200;
  static constexpr Eigen::Index most_unknowns = 4500;  ///< of a dense matrix

  /// @param K  [3 vertices x 3 vertices], xyz interleaved [N/m]
  /// @param M  [vertices x vertices] [kg]
  CoarseModes(Eigen::MatrixXd K, const RowMatrix& M);

  /// S = Phi s Phi^T [1/kg]. With all modes s = min(sinc^2(w t / 2), kappa / (w t)^2), beyond w t =
  /// pi only the latter: leapfrog then has the exact frequency of each mode below, and none is
  /// faster than kappa allows. Else (M + t^2 K / kappa)^-1.
  Eigen::MatrixXd answer(double t, double kappa) const;

  /// The largest t^2 w^2 s, at most kappa.
  double largest(double t, double kappa) const;

  Eigen::Index unknowns() const { return unknowns_; }

 private:
  Eigen::Index unknowns_;
  Eigen::MatrixXd K_, M_, modes_;  // K and M only without the modes
  Eigen::VectorXd squares_;        // w^2 [1/s^2]
};

/// A coarser level as a space of motions of the finest mesh.
struct MassSpace {
  RowMatrix up;  ///< P, [finer level's vertices x vertices]
  /// M = P^T (the finer level's M) P, except on the last its main entries [kg]
  RowMatrix mass;
  /// of D = sum of |M| along a row [1/kg]; 0: no motion here
  std::vector<double> inverse_diagonal;
  std::vector<double> scale;  ///< E, by which Q = D^-1 (2 - M D^-1) becomes E Q E: a translation
                              ///< stays one; not of the last
};

/// The coarser levels' spaces, finest first, of their transfers. E solves E Q E M 1 = 1 (Sinkhorn &
/// Knopp 1967): on irregular levels Q alone answers forces that accelerate the whole body by
/// anything from -0.2 to 1.2 of that.
/// @param transfers  [i]: level i + 1's vertices to level i's
/// @param mass       of the finest level's vertices [kg]
std::vector<MassSpace> mass_spaces(std::vector<RowMatrix> transfers,
                                   const std::vector<double>& mass);

/// The product of all transfers: the coarsest level's space in the finest mesh. Weights below 1e-4
/// go to the largest of their row.
RowMatrix to_finest(const std::vector<MassSpace>& spaces);

}  // namespace plica
