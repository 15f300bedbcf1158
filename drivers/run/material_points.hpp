// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/model.hpp>
#include <plica/core/transfer.hpp>
#include <vector>

namespace plica {

/// Points of a body that are watched: each follows the tetrahedron it lies in at rest.
template <class B>
class MaterialPoints {
 public:
  using Exec = typename B::Exec;  ///< where they are gathered
  /// In the order of the points.
  struct Motion {
    std::vector<Point> displacement;  ///< [m]
    std::vector<Point> velocity;      ///< [m/s]
  };

  /// A point outside the mesh is taken to the nearest point of it. InputError for points that are
  /// not finite.
  MaterialPoints(const TetMesh& mesh, const std::vector<Point>& points);

  const std::vector<Point>& rest() const { return rest_; }  ///< where they lie at rest [m]

  /// From a level's fields [vertices][3], gathered on the device in the order of `exec`; waits.
  Motion sample(const Exec& exec, const Vectors<B>& displacement, const Vectors<B>& velocity) const;

 private:
  Transfer<B> transfer_;
  State<B> gathered_;
  std::vector<Point> rest_;
};

}  // namespace plica
