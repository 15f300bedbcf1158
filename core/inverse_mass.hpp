// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <vector>

/// The arrays of the hierarchical inverse mass, see cmake/docs/him.md.
namespace plica {

/// A coarser level, as the inverse mass sees it: a space of motions of the finest mesh, without
/// elements or state. Except on the coarsest level its vertices count in units that make the
/// inverse of its lumped mass 1: forces times s, accelerations over s, s^2 that inverse. Matrices
/// are in float: P and its transpose are rounded alike, which keeps the inverse mass symmetric.
template <class B>
struct MassLevel {
  int vertices = 0;
  SparseRows<B, float> up;    ///< P: values at this level's vertices -> at the next finer one's
  SparseRows<B, float> down;  ///< its transpose
  /// M = P^T (the finer level's M) P, its main entries; empty on the coarsest level
  SparseRows<B, float> mass;
  SparseRows<B, float> share;  ///< Pi^T E^T: momentum here per momentum on u_C, see CoarseAxes;
                               ///< empty on the coarsest level
  Vectors<B> force;            ///< restricted
  Vectors<B> acceleration;     ///< of this level and those below it
};

/// What the coarsest level answers forces with: the modes of its own linear problem, in axes that
/// turn with the body.
template <class B>
struct CoarseFilter {
  static constexpr int group = 16;         ///< vertices whose rows lie together
  static constexpr int block = 3 * group;  ///< such rows
  int vertices = 0;
  Kokkos::View<float*, typename B::Memory>
      matrix;           ///< S, symmetric, [blocks of rows][3 vertices columns][block] [1/kg]
  Vectors<B> turned;    ///< R^T force
  Vectors<B> rotation;  ///< R, [3 vertices][3], three rows each
};

/// How the coarsest level's axes follow the body: u_C = E u; G = its gradient around a vertex; R =
/// the rotation nearest to G. And the force by which they act back, g on u_C. Dense matrices lie as
/// [groups of vertices][columns][group], see dense_rows().
template <class B>
struct CoarseAxes {
  template <class Number>
  using Dense = Kokkos::View<Number*, typename B::Memory>;

  SparseRows<B> restriction, spread;       ///< E, from the finest mesh, and its transpose
  Dense<typename B::Real> gradient_of[3];  ///< column j of G - G at rest, of u_C: n columns each
  Dense<typename B::Real> force_of;        ///< its transpose: 3 n columns
  /// what torques add to the coarse momentum per second: Pi^T E^T times that
  Dense<float> response;
  /// G at rest is this times 1: 1, or 0 where the axes do not turn
  Scalars<B> at_rest;
  Vectors<B> displacement;  ///< u_C [m]
  /// per work item the sum of the squares of the angles of a turn [rad^2]
  Doubles<B> angles;
  /// (tr U 1 - U)^-1, U = R^T G, [3 vertices][3]; 0: R is not the nearest
  Vectors<B> stiffness;
  /// what G is turned by, [3 vertices][3], its columns one after the other
  Vectors<B> torque;
  Vectors<B> force;  ///< g [N]
};

}  // namespace plica
