// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/keys.hpp>
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// Options of a solid box.
struct BlockOptions {
  Point centre = Point::Zero();  ///< [m]
  Point size = Point::Ones();    ///< edges [m]
  /// Rotation about the centre: the direction is the axis, the length the angle [rad]
  Point rotation = Point::Zero();
};

/// Describes the parameters of a box: name, kind, unit, range and meaning.
template <class V>
void describe(V& v, BlockOptions& o) {
  using namespace keys;
  v("centre", o.centre, Vector{length}, "centre");
  v.required("size", o.size, Vector{length, positive}, "edges");
  v("rotation", o.rotation, Vector{angle},
    "about the centre: [0, 0, 30 deg] turns it by 30 degrees about z");
}

/// Box in any orientation. The nearest point is on a face, an edge or a corner.
struct Block {
  /// Name of the shape in scenes
  static constexpr const char* name = "box";
  /// One line about the shape, for lists
  static constexpr const char* summary = "a solid box";
  /// Returns the centre, about which torques on the obstacle are at t = 0 [m].
  static Point origin(const BlockOptions& o) { return o.centre; }
  /// Returns the radius of the largest ball in the box [m].
  static double radius(const BlockOptions& o) { return o.size.minCoeff() / 2; }
  using Options = BlockOptions;  ///< parameters of the shape

  /// Signed distance to the box, as kernels evaluate it.
  template <class Real>
  struct Shape {
    static constexpr bool convex = true;  ///< true where the solid is convex
    Vec3<Real> centre;                    ///< [m]
    Mat3<Real> axes;                      ///< rows: directions of the edges
    Vec3<Real> half;                      ///< half of the edges' lengths [m]

    /// Returns distance and normal at a position in the axes of the shape [m].
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = axes * (x - centre);
      Vec3<Real> beyond;  // the faces
      Real squared = 0;
      int nearest = 0;
      Real depth[3];
      for (int k = 0; k < 3; ++k) {
        depth[k] = (d[k] < 0 ? -d[k] : d[k]) - half[k];
        beyond[k] = depth[k] > 0 ? (d[k] < 0 ? -depth[k] : depth[k]) : Real(0);
        squared += beyond[k] * beyond[k];
        if (depth[k] > depth[nearest]) nearest = k;
      }
      if (!(squared > 0))
        return {depth[nearest], (d[nearest] < 0 ? Real(-1) : Real(1)) * axes[nearest]};
      const Real r = sqrt(squared);
      return {r, (Real(1) / r) * (transpose(axes) * beyond)};
    }
  };

  /// Returns the shape with these options, for kernels.
  template <class Real>
  static Shape<Real> shape(const Options& o) {
    const double turn = o.rotation.norm();
    const Point axis = turn > 0 ? Point(o.rotation / turn) : Point::UnitZ();
    const Eigen::Matrix3d turned = Eigen::AngleAxisd(turn, axis).toRotationMatrix();
    Mat3<Real> axes;
    for (int k = 0; k < 3; ++k) axes[k] = vec3<Real>(turned.col(k));
    return {vec3<Real>(o.centre), axes, vec3<Real>(o.size / 2)};
  }
};

}  // namespace plica
