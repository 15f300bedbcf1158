// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/problem.hpp>
#include <plica/meshes/embedding.hpp>
#include <string>
#include <vector>

// Several bodies in one: which vertices and points belong to which body (part). Where there is one
// body, the list of parts is empty, and so are the lists of part numbers.
namespace plica {

/// Returns the part of each vertex of a level.
std::vector<int> parts_of_vertices(const TetMesh& mesh, const std::vector<BodyPart>& parts);
/// Returns the part of each point of the surface.
std::vector<int> parts_of_points(const std::vector<BodyPart>& parts);

/// Finds points in a level's mesh, each in its own body, even if another body is nearer.
class BodyLocator {
 public:
  /// Builds a tree for each part. Keeps a reference to the mesh where it is one body.
  BodyLocator(const TetMesh& mesh, const std::vector<BodyPart>& parts);

  /// Embeds points in the mesh, each in the body of its part. `part`: part of each point; empty:
  /// there is one body.
  Embedding embed(const std::vector<Point>& points, const std::vector<int>& part,
                  Outside outside) const;
  double distance(const Point& point) const;  ///< distance to the nearest element [m]
  double mean_edge(std::size_t part) const;   ///< mean edge length of a part [m]

 private:
  struct One {
    std::unique_ptr<TetMesh> mesh;  ///< mesh of the part; none: the whole mesh
    std::vector<int> vertex;        ///< number of each of its vertices in the whole mesh
    std::unique_ptr<TetLocator> locator;
  };
  std::vector<One> parts_;
};

/// Throws InputError where a point of one body's surface is deeper inside another's than contact
/// allows. The message has the deepest such point. `edge`: mean edge length of the finest level
/// [m].
void expect_apart(const TriangleSurface& surface, const std::vector<BodyPart>& parts, double edge);

}  // namespace plica
