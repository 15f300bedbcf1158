// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/transfer.hpp>
#include <plica/kernels/vectors.hpp>

// Copies between a simulation and its caller's arrays, in any precision and layout. Per vertex 3 or
// 6 values in and 3 out.
namespace plica {

/// Computes position x and velocity of surface point p from a level's state.
template <class B>
KOKKOS_INLINE_FUNCTION void surface_point(const EmbeddedSurface<B>& s, const Vectors<B>& u,
                                          const Vectors<B>& v, int p, Vec3<typename B::Real>& x,
                                          Vec3<typename B::Real>& speed) {
  x = value_at<B>(s.embedding, u, p, vector_at<B>(s.rest, p));
  speed = value_at<B>(s.embedding, v, p);
}

/// Copies positions: out = rest + u.
template <class B, class Out>
struct ReadPositions {
  Vectors<B> rest, u;
  Out out;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    using T = typename Out::value_type;
    for (int k = 0; k < 3; ++k) out(a, k) = static_cast<T>(rest(a, k)) + static_cast<T>(u(a, k));
  }
};

/// Copies vectors: out = v.
template <class B, class Out>
struct ReadVectors {
  Vectors<B> v;
  Out out;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) out(a, k) = static_cast<typename Out::value_type>(v(a, k));
  }
};

/// Sets displacements from positions: u = x - rest.
template <class B, class In>
struct WritePositions {
  In x;
  Vectors<B> rest, u;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    using T = typename In::non_const_value_type;
    for (int k = 0; k < 3; ++k)
      u(a, k) = static_cast<typename B::Real>(x(a, k) - static_cast<T>(rest(a, k)));
  }
};

/// Sets vectors: v = x.
template <class B, class In>
struct WriteVectors {
  In x;
  Vectors<B> v;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) v(a, k) = static_cast<typename B::Real>(x(a, k));
  }
};

/// Copies the surface points' positions, or their velocities.
template <class B, class Out>
struct ReadSurfacePoints {
  EmbeddedSurface<B> surface;
  State<B> state;
  bool velocity;
  Out out;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    Vec3<typename B::Real> x, v;
    surface_point(surface, state.u, state.v, p, x, v);
    for (int k = 0; k < 3; ++k)
      out(p, k) = static_cast<typename Out::value_type>(velocity ? v[k] : x[k]);
  }
};

}  // namespace plica
