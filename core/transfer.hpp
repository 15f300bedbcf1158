// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>

namespace plica {

/// Values at some points (a mesh's vertices, a surface's) as weighted sums of four vertices of
/// another mesh. A target without a row keeps its own value: constrained vertices, and those
/// outside the other mesh where that is asked for.
template <class B>
struct Transfer {
  /// Number of targets that have a row
  int rows = 0;
  Indices<B> target;  ///< [rows]
  /// [rows] vertices of the other mesh
  Kokkos::View<int* [4], Kokkos::LayoutRight, typename B::Memory> source;
  /// [rows] weights, which sum to 1 in each row
  Kokkos::View<typename B::Real* [4], Kokkos::LayoutRight, typename B::Memory> weight;
};

/// Adjoint of an interpolation, in gather form. Each coarse vertex has a row of the finer ones in
/// its elements, in order. Forces take the interpolation's own weights. States take averages by
/// mass, which keep momentum where masses are inherited.
template <class B>
struct Restriction {
  int rows = 0;        ///< coarse vertices, one row each
  Indices<B> first;    ///< [rows + 1] into source, weight and average
  Indices<B> source;   ///< a finer vertex, ascending in a row
  Scalars<B> weight;   ///< weight of its force; 0 where it is only averaged
  Scalars<B> average;  ///< weight of its state; each row sums to 1
};

/// Surface points of the body in one level: x = rest + sum of weight * u. Forces take the
/// transpose, in gather form, so that every vertex adds its points in a fixed order.
template <class B>
struct EmbeddedSurface {
  int points = 0;     ///< points of the surface; 0: the level carries none
  Vectors<B> rest;    ///< [points][3]
  Indices<B> number;  ///< [points] number in the whole surface; empty: the rank has all of it
  /// [points] 1 where this rank owns the point; 0: a copy, which sums leave out; empty: it owns all
  Indices<B> counted;
  Transfer<B> embedding;  ///< a row per point, in order
  int touched = 0;        ///< vertices with a point in one of their tetrahedra
  Indices<B> vertex;      ///< [touched]
  Indices<B> first;       ///< [touched + 1] into point and weight
  Indices<B> point;       ///< a surface point
  Scalars<B> weight;      ///< weight of the vertex in that point
};

}  // namespace plica
