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
  SparseRows<B> up;             ///< P: values at this level's vertices -> at the next finer one's
  SparseRows<B> down;           ///< its transpose
  SparseRows<B> mass;           ///< M D^-1, M = P^T (the finer level's M) P; empty on the coarsest level
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

/// How the coarsest level's axes follow the body: u_C = E u; D = the volumes' sum of deformation gradients around a vertex;
/// R = the rotation nearest to W D. And the force by which they act back, g on u_C.
template <class B>
struct CoarseAxes {
  SparseRows<B> restriction, spread;      ///< E, from the finest mesh, and its transpose
  SparseRows<B> smoothing, smoothing_of;  ///< W, and its transpose
  SparseRows<B> response;                 ///< Pi^T E^T: coarse momentum per momentum on u_C
  Indices<B> first, place;                ///< of each vertex in its elements, in order: 4 element + corner
  Kokkos::View<int* [4], Kokkos::LayoutRight, typename B::Memory> corner;  ///< of each element
  Kokkos::View<typename B::Real* [10], Kokkos::LayoutRight, typename B::Memory>
      shape;                ///< inverse edges, volume / mean
  Vectors<B> displacement;  ///< u_C [m]
  Vectors<B> of_tet;        ///< volume times deformation gradient, later the force's, [3 elements][3]
  Vectors<B> gradient;      ///< D, later what turns it, [3 vertices][3]
  Vectors<B> stiffness;     ///< (tr U 1 - U)^-1, U = R^T W D, [3 vertices][3]; 0: R is not the nearest
  Vectors<B> torque;        ///< what W D is turned by, [3 vertices][3]
  Vectors<B> force;         ///< g [N]
};

}  // namespace plica
