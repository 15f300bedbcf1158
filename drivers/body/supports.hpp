// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Vertex that is held along one or two directions, and slides across them.
struct SlidingVertex {
  int vertex = 0;
  /// Unit vectors at right angles; the second is 0 where the vertex is held along one
  std::array<Point, 2> normals = {Point::Zero(), Point::Zero()};
};

/// Vertices of an entry of body.fixed or body.prescribed, with its part of what holds them.
struct HeldSet {
  std::string name;  ///< see held_names()
  /// Centre of the bounding box of the vertices chosen, at rest and before the body is placed [m]
  Point centre = Point::Zero();
  std::vector<int> vertex;  ///< ascending
  /// Matrix for each of these, from the force that holds the vertex to this set's part of it
  std::vector<Eigen::Matrix3d> share;
};

/// Supports of the vertices of a level.
struct Supports {
  std::vector<char> constrained;       ///< per vertex: all of its motion is given
  std::vector<int> prescribed_vertex;  ///< vertices that follow a given motion
  std::vector<int> prescribed_motion;  ///< index of the body's motion that each of these follows
  std::vector<SlidingVertex> sliding;  ///< vertices that are held in part
  std::vector<HeldSet> sets;           ///< entries of body.fixed, then those of body.prescribed
};

/// Returns the names of the entries of body.fixed, then of body.prescribed: "fixed_0",
/// "prescribed_0". With several bodies they begin with a body's name: "left.fixed_0".
std::vector<std::string> held_names(const Body& body);

/// Finds what holds the vertices of a level, whose mesh is at rest and not placed.
///
/// The directions that hold a vertex come from all sets that choose it, body.fixed first. A
/// direction counts where at least a tenth of it is at right angles to those before. The force on
/// the vertex is a sum of forces along these directions; each belongs to the set that its direction
/// came from. Three directions hold all motion.
///
/// Throws InputError where a selection chooses nothing, a vertex has two motions, or is held along
/// a direction in which it is moved. Throws it also where the normal of a surface is asked for at
/// an edge.
Supports find_supports(const Body& body, const TetMesh& mesh, int level);

}  // namespace plica
