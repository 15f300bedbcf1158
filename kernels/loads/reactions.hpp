// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/kernels/reduce.hpp>

// Forces that hold vertices. A vertex of mass m whose acceleration a is given needs R = m a + c m v
// - f, with f all other forces on it and c its mass damping. On directions that hold a sliding
// vertex a and v are 0.
namespace plica {

/// Subtracts m (a + c v) of the vertices whose motion is given from f, which becomes -R.
template <class B>
struct SubtractInertia {
  PrescribedVertices<B> given;
  VertexModel<B> model;
  Vectors<B> v, f;
  double time;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = given.vertex(i);
    const Vec3<double> acceleration = given_acceleration(given, i, time);
    const double m = static_cast<double>(model.mass(a)), c = static_cast<double>(model.damping(a));
    for (int k = 0; k < 3; ++k)
      f(a, k) -=
          static_cast<typename B::Real>(m * (acceleration[k] + c * static_cast<double>(v(a, k))));
  }
};

/// Force of a set of held vertices on the body, and its moment about a point.
template <class B>
struct SetReaction {
  Indices<B> vertex;
  /// [vertices][9] matrix from R of each to the set's part of it, row by row
  Kokkos::View<double* [9], Kokkos::LayoutRight, typename B::Memory> share;
  Vectors<B> minus_R, rest, u;
  Vec3<double> about;

  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int i) const {
    const int a = vertex(i);
    Vec3<double> force, arm;
    for (int k = 0; k < 3; ++k) {
      arm[k] = static_cast<double>(rest(a, k)) + static_cast<double>(u(a, k)) - about[k];
      for (int l = 0; l < 3; ++l)
        force[k] -= share(i, 3 * k + l) * static_cast<double>(minus_R(a, l));
    }
    const Vec3<double> moment = cross(arm, force);
    return {{force[0], force[1], force[2], moment[0], moment[1], moment[2]}};
  }
};

/// Part of a vertex in the force of a set, for sums over all vertices.
template <class B>
struct ReactionOfVertex {
  Indices<B> place;  ///< [vertices] number in the set; -1: the set does not hold the vertex
  SetReaction<B> set;
  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int a) const {
    return place(a) < 0 ? Sums<6>{} : set(place(a));
  }
};

}  // namespace plica
