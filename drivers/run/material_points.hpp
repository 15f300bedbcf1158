// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/model.hpp>
#include <plica/core/transfer.hpp>
#include <vector>

namespace plica {

/// Points of a body whose motion is sampled: each follows the tetrahedron it lies in at rest.
template <class B>
class MaterialPoints {
 public:
  using Exec = typename B::Exec;  ///< execution space that gathers them
  /// Motion of all points, in their order.
  struct Motion {
    std::vector<Point> displacement;  ///< [m]
    std::vector<Point> velocity;      ///< [m/s]
  };

  /// Finds the points in the mesh at rest [m]. A point outside it is taken to the nearest point of
  /// it. Throws InputError for points that are not finite.
  MaterialPoints(const TetMesh& mesh, const std::vector<Point>& points);

  const std::vector<Point>& rest() const { return rest_; }  ///< places at rest [m]

  /// Samples a level's fields [vertices][3] m and m/s, on the device and in the order of `exec`.
  /// Waits.
  Motion sample(const Exec& exec, const Vectors<B>& displacement, const Vectors<B>& velocity) const;

 private:
  Transfer<B> transfer_;
  State<B> gathered_;
  std::vector<Point> rest_;
};

}  // namespace plica
