// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/sparse_rows.hpp>
#include <vector>

/// The arrays of the hierarchical inverse mass, see cmake/docs/him.md.
namespace plica {

/// A coarser level, as the inverse mass sees it: a space of motions of the finest mesh, without elements or state.
template <class B>
struct MassLevel {
  int vertices = 0;
  SparseRows<B> up;     ///< P: values at this level's vertices -> at the next finer one's
  SparseRows<B> down;   ///< its transpose
  SparseRows<B> mass;   ///< M D^-1, M = P^T (the finer level's M) P; empty on the coarsest level
  SparseRows<B> share;  ///< Pi^T E^T: momentum here per momentum on u_C, see CoarseAxes; empty on the coarsest level
  Scalars<B> inverse_diagonal;  ///< D^-1, D = the sum of |M| along a row [1/kg]; 0: no motion here
  Vectors<B> force;             ///< restricted [N]
  Vectors<B> acceleration;      ///< of this level and those below it [m/s^2]
};

/// What the coarsest level answers forces with: the modes of its own linear problem, in axes that turn with the body.
template <class B>
struct CoarseFilter {
  static constexpr int block = 16;  ///< rows that lie together
  int vertices = 0;
  Kokkos::View<float*, typename B::Memory>
      matrix;           ///< S, symmetric, [blocks of rows][3 vertices columns][block] [1/kg]
  Vectors<B> turned;    ///< R^T force
  Vectors<B> rotation;  ///< R, [3 vertices][3], three rows each
};

/// A linear map from vectors at some places to matrices at others: by rows, as the sum of vector times (row's) vector.
template <class B>
struct GradientRows {
  Indices<B> first;       ///< [rows + 1] into the others
  Indices<B> column;      ///< of an entry
  Vectors<B> derivative;  ///< [entries][3]
};

/// How the coarsest level's axes follow the body: u_C = E u; D = its gradient around a vertex, weighed; R = the rotation nearest
/// to W D. And the force by which they act back, g on u_C.
template <class B>
struct CoarseAxes {
  SparseRows<B> restriction, spread;      ///< E, from the finest mesh, and its transpose
  GradientRows<B> gradient_of;            ///< D of u_C
  GradientRows<B> gradient_to;            ///< its transpose
  Scalars<B> at_rest;                     ///< D at rest is this times 1
  SparseRows<B> smoothing, smoothing_of;  ///< W, and its transpose; W D = 1 at rest
  SparseRows<B> response;                 ///< Pi^T E^T: coarse momentum per momentum on u_C
  Vectors<B> displacement;                ///< u_C [m]
  Vectors<B> gradient;                    ///< D, later what turns it, [3 vertices][3]
  Vectors<B> stiffness;                   ///< (tr U 1 - U)^-1, U = R^T W D, [3 vertices][3]; 0: R is not the nearest
  Vectors<B> torque;                      ///< what W D is turned by, [3 vertices][3]
  Vectors<B> force;                       ///< g [N]
};

}  // namespace plica
