// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/kernels/contact/obstacle_place.hpp>
#include <plica/kernels/contact/touching_points.hpp>
#include <plica/kernels/exchange.hpp>
#include <plica/kernels/reduce.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// The force on each point with pairs or faces: its own pairs', and those that have it as one of their others. `bounding`: by
/// absolute weights, where rows of W A W^T are bounded.
template <class B>
struct SumPointForces {
  using Real = typename B::Real;
  TouchingPoints<B> points;
  bool bounding;
  KOKKOS_INLINE_FUNCTION void operator()(int q) const {
    const PairedPoints<B>& pairs = points.pairs;
    Vec3<Real> sum = points.force_of_obstacles(q);
    if (pairs.triangles > 0) add_pairs(q, sum);
    set_vector<B>(pairs.sum, q, sum);
  }
  KOKKOS_INLINE_FUNCTION void add_pairs(int q, Vec3<Real>& sum) const {
    const PairedPoints<B>& pairs = points.pairs;
    const auto force = [&](int pair) { return vector_at<B>(points.force, points.record(points.obstacles, 0) + pair); };
    for (int row = 0, pair = q; row < pairs.rows(); ++row, pair += points.points)
      sum += pairs.own_weight(pair) * force(pair);
    pairs.each_pair_at(
        q, [&](int pair, Real weight) { sum += weight * force(pair); }, bounding);
  }
};

/// How deep a site is in an obstacle [m]; 0 outside, and of a point that it holds. A face's record has what is beyond its corners.
template <class B>
struct DepthInObstacle {
  TouchingPoints<B> points;
  int obstacle;
  KOKKOS_INLINE_FUNCTION Sums<1, 1> operator()(int site) const {
    const FaceSites<B>& faces = points.faces;
    const int r = points.record(obstacle, site), t = site - points.points;
    if (points.held.holds(r) || !(points.depth(r) > 0)) return {};
    double depth = static_cast<double>(points.depth(r));
    for (int c = 0; t >= 0 && c < 3; ++c) {
      const auto of_corner = points.depth(points.record(obstacle, faces.corner(3 * t + c)));
      if (of_corner > 0) depth += static_cast<double>(faces.weight(faces.site(obstacle, t), c) * of_corner);
    }
    return {{depth}};
  }
};

/// x = 0
template <class B>
struct ZeroVectors {
  Vectors<B> x;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { set_vector<B>(x, a, {}); }
};

/// f += transpose of the embedding times the point forces, each vertex adding its points in order.
template <class B>
struct ScatterToVertices {
  EmbeddedSurface<B> surface;
  Vectors<B> force;  ///< [points][3]
  Vectors<B> f;      ///< [vertices][3]

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = surface.vertex(i);
    Vec3<typename B::Real> sum;
    for (int s = surface.first(i); s < surface.first(i + 1); ++s)
      for (int k = 0; k < 3; ++k) sum[k] += surface.weight(s) * force(surface.point(s), k);
    set_vector<B>(f, a, vector_at<B>(f, a) + sum);
  }
};

/// The same of all contact's forces.
template <class B>
struct ScatterContact {
  EmbeddedSurface<B> surface;
  TouchingPoints<B> points;
  Vectors<B> f;
  Indices<B> reached = {};  ///< [touched] 0: none on that vertex; empty: not known
  VertexModel<B> model = {};
  typename B::Real damped = 0;  ///< what mass damping leaves of it; see ContactStep
  bool bounding = false;        ///< by absolute weights

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    if (reached.extent(0) > 0 && reached(i) == 0) return;
    const int a = surface.vertex(i);
    const auto kept = damped > 0 ? 1 / (1 + damped * model.damping(a)) : typename B::Real(1);
    set_vector<B>(f, a, vector_at<B>(f, a) + kept * points.force_on(surface, i, bounding));
  }
};

template <class B>
void scatter_to_vertices(const typename B::Exec& exec, const EmbeddedSurface<B>& surface, const Vectors<B>& force,
                         const Vectors<B>& f) {
  update_vertices<B>(exec, "plica::scatter_to_vertices", surface.touched, ScatterToVertices<B>{surface, force, f});
}

/// Potential energy of the penalties and springs of one obstacle, as a field of the points [J].
template <class B, class Shape>
struct ContactEnergy {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> u, v;
  Shape shape;
  ObstaclePlace<B> place;
  PointLaws<B> law;
  HeldPoints<B> held;
  int obstacle;

  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int p) const {
    Vec3<Real> x, speed;
    surface_point(surface, u, v, p, x, speed);
    if (const int r = obstacle * surface.points + p; held.holds(r)) {
      const Vec3<Real> stretch = held.stretch(r, x, place.way(x));
      return {{0.5 * static_cast<double>(held.law(obstacle, p).stiffness * dot(stretch, stretch))}};
    }
    const Real penetration = max(-shape(place.local(x)).distance, Real(0));
    return {{0.5 * static_cast<double>(law(obstacle, p).stiffness * penetration * penetration)}};
  }
};

}  // namespace plica
