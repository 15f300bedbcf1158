// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <vector>

/// Arrays of the hierarchical inverse mass, see cmake/docs/explanation/him.md.
namespace plica {

/// A coarser level of the inverse mass: a space of motions of the finest mesh, without elements or
/// state. Except on the coarsest level, vertices have units that make the inverse of the level's
/// lumped mass 1. Forces are multiplied by s and accelerations divided by s, with s^2 that inverse.
/// Matrices are in float: P and its transpose are rounded alike, which keeps the inverse mass
/// symmetric.
template <class B>
struct MassLevel {
  int vertices = 0;
  SparseRows<B, float> up;    ///< P: values at this level's vertices -> at the next finer one's
  SparseRows<B, float> down;  ///< P^T
  /// M = P^T (the finer level's M) P, main entries only; empty on the coarsest level
  SparseRows<B, float> mass;
  /// Pi^T E^T: momentum on this level per momentum on u_C, see FrameFields; empty on the coarsest
  /// level
  SparseRows<B, float> share;
  Vectors<B> force;         ///< force, restricted to this level
  Vectors<B> acceleration;  ///< acceleration by this level and those below it
};

/// Response of the coarsest level to forces: the modes of its own linear problem. They are in
/// frames that turn with the body.
template <class B>
struct CoarseInverseMass {
  static constexpr int group = 16;         ///< number of vertices whose rows lie together
  static constexpr int block = 3 * group;  ///< number of rows of such a group
  int vertices = 0;
  /// S, symmetric, [blocks of rows][3 vertices columns][block] [1/kg]
  Kokkos::View<float*, typename B::Memory> matrix;
  Vectors<B> turned;    ///< R^T force
  Vectors<B> rotation;  ///< R, [3 vertices][3]: three rows for each vertex
};

/// Axes of the coarsest level, which follow the body, and the force by which they act back. Coarse
/// displacements are u_C = E u. G is the deformation gradient around a vertex, R the rotation
/// nearest to G, and g the force on u_C. Dense matrices lie as [groups of
/// vertices][columns][group], see dense_rows().
template <class B>
struct FrameFields {
  template <class Number>
  using Dense = Kokkos::View<Number*, typename B::Memory>;

  SparseRows<B> restriction, spread;  ///< E, from the finest mesh, and its transpose
  /// Matrices from u_C to column j of G - G at rest: n columns each
  Kokkos::Array<Dense<typename B::Real>, 3> gradient_of;
  /// Transpose of gradient_of, from torques to g: 3 n columns
  Dense<typename B::Real> force_of;
  /// Pi^T E^T force_of, from torques to what they add to the coarse momentum per second
  Dense<float> response;
  /// Factor of the unit matrix in G at rest: 1, or 0 where the frames do not turn
  Scalars<B> at_rest;
  Vectors<B> displacement;  ///< u_C [m]
  /// Sum of the squares of the angles of a turn, per work item [rad^2]
  Doubles<B> angles;
  /// (tr U 1 - U)^-1, U = R^T G, [3 vertices][3]; 0 where R is not the nearest rotation
  Vectors<B> stiffness;
  /// Torque on the frames of each vertex, a 3x3 matrix column by column, [3 vertices][3]
  Vectors<B> torque;
  Vectors<B> force;  ///< g [N]
};

}  // namespace plica
