// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/transfer.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

namespace plica {

/// Points of the body's surface that one of several ranks has.
struct SurfacePart {
  std::vector<int> points;   ///< numbers in the whole surface, ascending
  std::vector<int> counted;  ///< [points] 1: at an owned vertex; empty: all are
  std::vector<int> owned;    ///< places in `points` of those at owned vertices
  TriangleSurface surface;   ///< the points, without triangles
  Embedding embedding;       ///< each at its vertex of the part
};

/// Returns the points at vertices where forces are complete: at owned vertices, and with linear
/// elements at copies. Throws InputError for a surface with points that are at no vertex.
SurfacePart surface_of_part(const TriangleSurface& surface, const TetMesh& mesh,
                            const LevelPart& level);

/// Returns the interpolation of these points from the part's vertices, see build_surface().
template <class B>
EmbeddedSurface<B> build_surface_part(const SurfacePart& points);

}  // namespace plica
