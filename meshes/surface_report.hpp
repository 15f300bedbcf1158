// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <string>

namespace plica {

/// What a reader of surfaces found, repaired and left out.
struct SurfaceReport {
  std::string format;          ///< like "STL binary"
  int unreferenced = 0;        ///< vertices of no triangle, dropped
  int collapsed = 0;           ///< triangles with a vertex twice, dropped
  int repeated = 0;            ///< triangles with the vertices of another one in the same turn, dropped
  int open_edges = 0;          ///< of one triangle only
  int crowded_edges = 0;       ///< of more than two: the surface is no manifold there
  int inconsistent_edges = 0;  ///< of two triangles that look to different sides
  int parts = 0;               ///< that share no vertex
  bool turned = false;         ///< closed, but inside out: all triangles were turned

  /// Whether it has an inside.
  bool closed() const { return open_edges == 0 && crowded_edges == 0 && inconsistent_edges == 0; }
};

/// Adds its edges that keep a surface from having an inside to the report.
void count_edges(const TriangleSurface& surface, SurfaceReport& report);

}  // namespace plica
