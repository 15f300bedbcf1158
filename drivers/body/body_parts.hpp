// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/problem.hpp>
#include <plica/meshes/embedding.hpp>
#include <string>
#include <vector>

// Several bodies in one: who is whose. Parts without number stand for one body, and lists of them
// are empty then.
namespace plica {

/// Per vertex of a level its part.
std::vector<int> parts_of_vertices(const TetMesh& mesh, const std::vector<BodyPart>& parts);
/// Per point of the surface its part.
std::vector<int> parts_of_points(const std::vector<BodyPart>& parts);

/// Finds points in a level's mesh, each in its own body, however near another one is.
class BodyLocator {
 public:
  /// Keeps a reference to the mesh where it is one body.
  BodyLocator(const TetMesh& mesh, const std::vector<BodyPart>& parts);

  /// As embed(); `part`: of each point, as above.
  Embedding embed(const std::vector<Point>& points, const std::vector<int>& part,
                  Outside outside) const;
  double distance(const Point& point) const;  ///< to the nearest of its elements [m]
  double mean_edge(std::size_t part) const;   ///< [m]

 private:
  struct One {
    std::unique_ptr<TetMesh> mesh;  ///< its own; none: the whole one
    std::vector<int> vertex;        ///< of each of these its number in the whole
    std::unique_ptr<TetLocator> locator;
  };
  std::vector<One> parts_;
};

/// InputError where a point of one body's surface is inside another's by more than contact lets it,
/// with the deepest such point. `edge`: mean, of the finest level [m].
void expect_apart(const TriangleSurface& surface, const std::vector<BodyPart>& parts, double edge);

}  // namespace plica
