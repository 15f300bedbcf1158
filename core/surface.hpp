// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/transfer.hpp>

namespace plica {

/// The body's surface points in one level: x = rest + sum of weight * u, and the transpose for forces, in gather form
/// so that every vertex adds its points in a fixed order.
template <class B>
struct EmbeddedSurface {
  int points = 0;         ///< of the surface; 0: the level carries none
  Vectors<B> rest;        ///< [points][3]
  Transfer<B> embedding;  ///< a row per point, in order
  int touched = 0;        ///< vertices with a point in one of their tetrahedra
  Indices<B> vertex;      ///< [touched]
  Indices<B> first;       ///< [touched + 1] into point and weight
  Indices<B> point;       ///< a surface point
  Scalars<B> weight;      ///< of the vertex in it
};

}  // namespace plica
