// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Triangles around each point of a surface.
template <class B>
struct SurfaceFans {
  Indices<B> first;  ///< [points + 1] into others
  /// the other two corners of each triangle around the point, counter-clockwise seen from outside
  Indices<B> others;
};

/// Computes the unit normal of each surface point from the points' positions x. It is the mean of
/// the normals of the triangles around the point, weighted by their angles there, and 0 where all
/// of these are flat. Source: see normals_of_points().
template <class B, class Out>
struct SurfaceNormals {
  SurfaceFans<B> fans;
  Vectors<B> x;  // [m]
  Out out;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    using Real = typename B::Real;
    const Vec3<Real> at = vector_at<B>(x, p);
    Vec3<Real> sum;
    for (int k = fans.first(p); k < fans.first(p + 1); k += 2) {
      const Vec3<Real> one = vector_at<B>(x, fans.others(k)) - at;
      const Vec3<Real> other = vector_at<B>(x, fans.others(k + 1)) - at;
      const Vec3<Real> normal = cross(one, other);
      const Real length = Kokkos::sqrt(dot(normal, normal));
      if (length > Real(0)) sum += Kokkos::atan2(length, dot(one, other)) / length * normal;
    }
    const Real length = Kokkos::sqrt(dot(sum, sum));
    for (int k = 0; k < 3; ++k)
      out(p, k) =
          static_cast<typename Out::value_type>(length > Real(0) ? sum[k] / length : Real(0));
  }
};

}  // namespace plica
