// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <vector>

// Symbols of cmake/docs/explanation/him.md: S is CoarseModes::answer(). K_C and M_C are K and M of
// its constructor, Phi is modes_, omega^2 is squares_. P_i, M_i+1 and D of M_i+1 are MassSpace::up,
// mass and inverse_diagonal (D^-1) of space i.
namespace plica {

/// Linear problem K phi = w^2 M phi of the coarsest level at rest, and the inverse mass S of its
/// modes. Motions with almost no mass in M, and those that are nearly a combination of others, are
/// left out.
class CoarseModes {
 public:
  /// maximum unknowns for which modes are computed; larger levels use the matrix of implicit Euler
  static constexpr Eigen::Index most_modes = 1200;
  static constexpr Eigen::Index most_unknowns = 4500;  ///< maximum unknowns of a dense matrix

  /// @param K  [3 vertices x 3 vertices], xyz interleaved [N/m]
  /// @param M  [vertices x vertices] [kg]
  CoarseModes(Eigen::MatrixXd K, const RowMatrix& M);

  /// Returns S = Phi s Phi^T [1/kg] where modes were computed, else S = (M + t^2 K / kappa)^-1.
  /// s = min(sinc^2(w t / 2), kappa / (w t)^2) up to w t = pi, and s = min(1, kappa / (w t)^2)
  /// beyond. Leapfrog then has the exact frequency of each mode with w t < pi, and no mode is
  /// faster than kappa allows.
  Eigen::MatrixXd answer(double t, double kappa) const;

  /// Returns the largest t^2 w^2 s of all modes, at most kappa.
  double largest(double t, double kappa) const;

  Eigen::Index unknowns() const { return unknowns_; }

 private:
  Eigen::Index unknowns_;
  Eigen::MatrixXd K_, M_, modes_;  // K and M only without the modes
  Eigen::VectorXd squares_;        // w^2 [1/s^2]
};

/// Coarser level, as a space of motions of the finest mesh.
struct MassSpace {
  RowMatrix up;  ///< P, [finer level's vertices x vertices]
  /// M = P^T (the finer level's M) P [kg]; on all but the last level only the main entries
  RowMatrix mass;
  /// D^-1, D = sum of |M| along a row [1/kg]; 0: no motion here
  std::vector<double> inverse_diagonal;
  /// E: Q = D^-1 (2 - M D^-1) becomes E Q E, so that a translation stays one; empty on the last
  /// level
  std::vector<double> scale;
};

/// Returns the coarser levels' spaces, finest first, made from their transfers.
/// E solves E Q E M 1 = 1 (Sinkhorn & Knopp 1967). Without E, on irregular levels, forces that
/// should accelerate the whole body alike give -0.2 to 1.2 times that acceleration.
/// @param transfers  [i]: from level i + 1's vertices to level i's
/// @param mass       mass of each vertex of the finest level [kg]
std::vector<MassSpace> mass_spaces(std::vector<RowMatrix> transfers,
                                   const std::vector<double>& mass);

/// Returns Pi, the product of all transfers: from the coarsest level's space to the finest mesh.
/// Weights below 1e-4 are added to the largest weight of their row.
RowMatrix to_finest(const std::vector<MassSpace>& spaces);

}  // namespace plica
