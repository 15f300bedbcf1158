// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/surface.hpp>
#include <plica/kernels/contact/attached_points.hpp>
#include <plica/kernels/contact/face_sites.hpp>
#include <plica/kernels/contact/held_points.hpp>
#include <plica/kernels/contact/obstacle_place.hpp>
#include <plica/kernels/contact/paired_points.hpp>
#include <plica/kernels/contact/point_laws.hpp>
#include <plica/kernels/exchange.hpp>
#include <plica/kernels/reduce.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Where surface points are told of that are further inside an obstacle than makes sense, or nowhere: the last of them + 1.
template <class B>
struct DepthWatch {
  Indices<B> lost;           ///< [1]
  typename B::Real deepest;  ///< [m]
  KOKKOS_INLINE_FUNCTION void look(int p, typename B::Real distance) const {
    if (!(distance >= -deepest)) Kokkos::atomic_max(&lost(0), p + 1);
  }
};

/// Contact of a level's surface points, on the device: a row of records for every obstacle, and with pairs one more; a record for
/// every point in it. Then come records for the surface's faces, a row for every obstacle. A site is a point, or then a face.
template <class B>
struct TouchingPoints {
  using Real = typename B::Real;
  int points = 0, obstacles = 0;
  Real reach = 0;  ///< a point further than that outside an obstacle is not looked at, but where it is fast [m]
  Real span = 0;   ///< of the step [s]
  PointLaws<B> law;
  PairedPoints<B> pairs;       ///< empty where the surface does not touch itself
  FaceSites<B> faces;          ///< empty where no obstacle is thin
  HeldPoints<B> held;          ///< empty where no obstacle can hold anything
  AttachedPoints<B> attached;  ///< empty where bodies are not attached to each other; in the row of pairs
  Vectors<B> normal;    ///< [records][3] out of the obstacle, or of the triangle; of a held point its stretch [m]
  Vectors<B> velocity;  ///< of the point relative to it [m/s]
  Scalars<B> depth;     ///< > 0 inside [m]
  Scalars<B> mobility;  ///< rho [1/kg]; before the first sweep, 1: it is near; 0: it does not touch
  Vectors<B> force;     ///< on the point [N]
  Blocks<B> block;      ///< [points][6] kg, of all obstacles, on implicit levels only
  Doubles<B> count;     ///< [1] records that touch

  KOKKOS_INLINE_FUNCTION int rows() const { return obstacles + (pairs.triangles > 0 ? 1 : 0); }
  KOKKOS_INLINE_FUNCTION int sites() const { return points + faces.triangles; }
  KOKKOS_INLINE_FUNCTION int rows_of(int site) const { return site < points ? rows() : obstacles; }
  KOKKOS_INLINE_FUNCTION int record(int row, int site) const {
    return site < points ? row * points + site : rows() * points + faces.site(row, site - points);
  }
  KOKKOS_INLINE_FUNCTION const PenaltyLaw<Real>& law_of(int row, int site) const {
    return law(row, site < points ? site : faces.corner(3 * (site - points)));
  }
  /// Whether it is held by a spring, instead of pushed.
  KOKKOS_INLINE_FUNCTION bool is_held(int row, int site) const {
    return row < obstacles ? held.holds(record(row, site)) : attached.holds(site);
  }
  KOKKOS_INLINE_FUNCTION const PenaltyLaw<Real>& spring_of(int row, int site) const {
    return row < obstacles ? held.law(row, site) : attached.law(attached.attachment(site));
  }
  /// What a field has at a site.
  KOKKOS_INLINE_FUNCTION Vec3<Real> value(const EmbeddedSurface<B>& surface, const Vectors<B>& x, int row,
                                          int site) const {
    return site < points ? value_at<B>(surface.embedding, x, site) : faces.value(surface, x, row, site - points);
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> place(const EmbeddedSurface<B>& surface, const Vectors<B>& u, int row,
                                          int site) const {
    Vec3<Real> x = value(surface, u, row, site);
    if (site < points) return x + vector_at<B>(surface.rest, site);
    const int t = site - points;
    for (int c = 0; c < 3; ++c)
      x += faces.weight(faces.site(row, t), c) * vector_at<B>(surface.rest, faces.corner(3 * t + c));
    return x;
  }
  static KOKKOS_INLINE_FUNCTION Real nowhere() { return Real(1e30); }  ///< how far away is what is near nothing [m]
  KOKKOS_INLINE_FUNCTION bool near(int r) const { return mobility(r) > 0; }
  KOKKOS_INLINE_FUNCTION Vec3<Real> force_on_point(int p) const {
    return pairs.sum.extent(0) > 0 ? vector_at<B>(pairs.sum, p) : force_of_obstacles(p);
  }
  /// On point p, its part of what the faces around it touch included.
  KOKKOS_INLINE_FUNCTION Vec3<Real> force_of_obstacles(int p) const {
    Vec3<Real> sum;
    for (int o = 0; o < obstacles; ++o) sum += vector_at<B>(force, record(o, p));
    if (faces.triangles == 0) return sum;
    for (int s = faces.first(p); s < faces.first(p + 1); ++s)
      for (int o = 0; o < obstacles; ++o) {
        const int t = faces.triangle(s);
        sum += faces.weight_of(o, t, p) * vector_at<B>(force, record(o, points + t));
      }
    return sum;
  }
  /// On the i-th touched vertex of the surface, its points in order.
  KOKKOS_INLINE_FUNCTION Vec3<Real> force_on(const EmbeddedSurface<B>& surface, int i) const {
    Vec3<Real> sum;
    for (int s = surface.first(i); s < surface.first(i + 1); ++s)
      sum += surface.weight(s) * force_on_point(surface.point(s));
    return sum;
  }
};

/// The force on each point with pairs or faces: what it touches, and what touches triangles around it. `reaction`: what a triangle
/// gets of a pair's force, -1; 1 where rows of W A W^T are bounded.
template <class B>
struct SumPointForces {
  using Real = typename B::Real;
  TouchingPoints<B> points;
  Real reaction;
  KOKKOS_INLINE_FUNCTION void operator()(int q) const {
    const PairedPoints<B>& pairs = points.pairs;
    Vec3<Real> sum = points.force_of_obstacles(q);
    if (pairs.triangles > 0) add_pairs(q, sum);
    set_vector<B>(pairs.sum, q, sum);
  }
  KOKKOS_INLINE_FUNCTION void add_pairs(int q, Vec3<Real>& sum) const {
    const PairedPoints<B>& pairs = points.pairs;
    sum += vector_at<B>(points.force, points.record(points.obstacles, q));
    for (int s = pairs.first(q); s < pairs.first(q + 1); ++s) {
      const int t = pairs.triangle(s);
      for (int i = pairs.from(t); i < pairs.from(t + 1); ++i) {
        const int p = pairs.point(i);
        sum += (reaction * pairs.weight_of(p, t, q)) * vector_at<B>(points.force, points.record(points.obstacles, p));
      }
    }
  }
};

/// Forces of one obstacle on the surface points [N], and each point's symmetric
/// 3x3 block (a k + b d) n n + b drag (1 - n n - slip slip) [kg], as xx yy zz xy xz yz, set by the first obstacle and added to by the
/// others, see ImplicitWeights: the coupling of friction to the normal force is left out, which keeps the matrix symmetric.
template <class B, class Shape>
struct ObstacleContact {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> u, v;
  Shape shape;
  ObstaclePlace<B> place;  ///< at the time of the state
  DepthWatch<B> watch;
  Real ahead, a, b;
  int obstacle;
  TouchingPoints<B> points;

  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    Vec3<Real> x, speed;
    surface_point(surface, u, v, p, x, speed);
    Gap<Real> gap = shape(place.local(x));
    gap.normal = place.outward(gap.normal);
    watch.look(p, gap.distance);
    const PenaltyLaw<Real>& law = points.law(obstacle, p);
    const PointContact<Real> c = penalty_contact(law, gap, speed - place.velocity(x), ahead);
    set_vector<B>(points.force, points.record(obstacle, p), c.force);
    const Real along = c.active ? a * law.stiffness + b * law.damping : Real(0),
               across = c.active ? b * c.drag : Real(0);
    constexpr int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};  // as in SymMat3
    for (int k = 0; k < 6; ++k) {
      const int i = row[k], j = column[k];
      const Real nn = c.normal[i] * c.normal[j], ss = c.slip[i] * c.slip[j];
      points.block(p, k) = (obstacle == 0 ? Real(0) : points.block(p, k)) + along * nn +
                           across * ((i == j ? Real(1) : Real(0)) - nn - ss);
    }
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

/// The same of all obstacles' forces.
template <class B>
struct ScatterContact {
  EmbeddedSurface<B> surface;
  TouchingPoints<B> points;
  Vectors<B> f;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = surface.vertex(i);
    set_vector<B>(f, a, vector_at<B>(f, a) + points.force_on(surface, i));
  }
};

template <class B>
void scatter_to_vertices(const typename B::Exec& exec, const EmbeddedSurface<B>& surface, const Vectors<B>& force,
                         const Vectors<B>& f) {
  Kokkos::parallel_for("plica::scatter_to_vertices", Kokkos::RangePolicy<typename B::Exec>(exec, 0, surface.touched),
                       ScatterToVertices<B>{surface, force, f});
}

/// y_p = block_p * (sum of weight * x), the point part of a product with the tangent.
template <class B>
struct PointProduct {
  EmbeddedSurface<B> surface;
  Vectors<B> x;
  Blocks<B> block;
  Vectors<B> y;

  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    set_vector<B>(y, p, block_at<B>(block, p) * value_at<B>(surface.embedding, x, p));
  }
};

/// Adds the point blocks' share to the vertices' own 3x3 blocks, [vertices][6] as above.
template <class B>
struct AddPointBlocks {
  EmbeddedSurface<B> surface;
  Blocks<B> block, diagonal;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = surface.vertex(i);
    for (int s = surface.first(i); s < surface.first(i + 1); ++s)
      for (int k = 0; k < 6; ++k) diagonal(a, k) += surface.weight(s) * surface.weight(s) * block(surface.point(s), k);
  }
};

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

/// A += W^T C W with the symmetric blocks C [points][6] of surface points and their weights W: a row of A per work item, its
/// points in order. Vertices of one tetrahedron are coupled in A already, unless the row's motion is given.
template <class B>
struct AddContact {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Blocks<B> block;
  BlockMatrix<B> A;

  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const int a = surface.vertex(item), first = A.first(a), last = A.first(a + 1);
    for (int s = surface.first(item); s < surface.first(item + 1); ++s) {
      const int p = surface.point(s);
      const SymMat3<Real> C = block_at<B>(block, p);
      for (int c = 0; c < 4; ++c) {
        int at = first;
        while (at < last && A.column(at) != surface.embedding.source(p, c)) ++at;
        if (at == last) continue;
        const Real w = surface.weight(s) * surface.embedding.weight(p, c);
        add_block<B>(A, at, w, C);
      }
    }
  }
};

}  // namespace plica
