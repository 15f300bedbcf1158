// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>

// Contact in the linear system of an implicit level. The penalty law of every record that touches, linearised about a state, has a
// symmetric 3x3 block C; the system has W^T C W of it, where W takes the values of vertices to the record's site:
//
//     vertices  --W-->  records  --C-->  records  --W^T-->  vertices
//
// In a pair W takes the triangle's value off the point's, so that the product couples two bodies. Points that touch obstacles couple
// the vertices of one tetrahedron, which is what an assembled matrix has room for; pairs and faces are in products alone.
namespace plica {

/// sum += scale block
template <class Real>
KOKKOS_INLINE_FUNCTION void add_scaled(SymMat3<Real>& sum, Real scale, const SymMat3<Real>& block) {
  for (int k = 0; k < 6; ++k) sum[k] += scale * block[k];
}

/// Force [N] of each record that was found, and its block (a k + b d) n n + a p G + b drag (1 - n n - slip slip) [kg], of a held point
/// (a k + b d) 1; see ImplicitWeights. p G is how the normal force p turns in a hollow, see concavity(). The coupling of friction to the
/// normal force is left out of it, which keeps it symmetric. Counts what touches.
template <class B>
struct LineariseTouching {
  using Real = typename B::Real;
  struct Answer {
    Vec3<Real> force;
    SymMat3<Real> block;
  };
  TouchingPoints<B> points;
  Real ahead, a, b;

  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int site) const {
    double count = 0;
    for (int row = 0; row < points.rows_of(site); ++row) {
      const int r = points.record(row, site);
      Answer answer;
      if (points.near(r)) answer = at(row, site, ahead);
      set_vector<B>(points.force, r, answer.force);
      set_block<B>(points.block, r, answer.block);
      count += points.is_stiff(r) ? 1 : 0;
    }
    return {{count}};
  }

  /// Of a record that is near, `later` than what was found [s].
  KOKKOS_INLINE_FUNCTION Answer at(int row, int site, Real later) const {
    const int r = points.record(row, site);
    return points.is_held(row, site) ? hold(points.spring_of(row, site), r, later)
                                     : push(points.law_of(row, site), r, later);
  }
  /// A record's normal, turned.
  KOKKOS_INLINE_FUNCTION Vec3<Real> turned(int r, const Vec3<Real>& turn) const {
    const Vec3<Real> N = vector_at<B>(points.normal, r);
    if (points.concavity.extent(0) == 0) return N;
    const Vec3<Real> there = N + turn;
    return (1 / Kokkos::sqrt(dot(there, there))) * there;
  }

 private:
  KOKKOS_INLINE_FUNCTION Answer hold(const PenaltyLaw<Real>& law, int r, Real later) const {
    Answer answer;
    const Vec3<Real> stretch = vector_at<B>(points.normal, r), v = vector_at<B>(points.velocity, r);
    answer.force = -law.stiffness * (stretch + later * v) - law.damping * v;
    for (int k = 0; k < 3; ++k) answer.block[k] = a * law.stiffness + b * law.damping;
    return answer;
  }

  KOKKOS_INLINE_FUNCTION Answer push(const PenaltyLaw<Real>& law, int r, Real later) const {
    Answer answer;
    const Vec3<Real> v = vector_at<B>(points.velocity, r), turn = points.turn(r, later * v);
    const Gap<Real> gap{-points.depth(r) - Real(0.5) * later * dot(v, turn), turned(r, turn)};
    const PointContact<Real> c = penalty_contact(law, gap, v, later);
    if (!c.active) return answer;
    answer.force = c.force;
    if (points.concavity.extent(0) > 0) add_scaled(answer.block, a * c.pressure, block_at<B>(points.concavity, r));
    const Real along = a * law.stiffness + b * law.damping, across = b * c.drag;
    constexpr int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};  // as in SymMat3
    for (int k = 0; k < 6; ++k) {
      const int i = row[k], j = column[k];
      const Real nn = c.normal[i] * c.normal[j], ss = c.slip[i] * c.slip[j];
      answer.block[k] += along * nn + across * ((i == j ? Real(1) : Real(0)) - nn - ss);
    }
    return answer;
  }
};

/// Takes each record to where a change of velocity dv leads it, with the change of displacement that goes with dv: where it touches stays as
/// it is, its normal turns as the system has it. With its last force F and block C, and those that it has there, its force becomes
/// b (F' - F) + C dv: what the system's right side gets beside what was solved [kg m/s]. Counts what touches before or after.
template <class B>
struct MoveTouching {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> change;
  LineariseTouching<B> law;  ///< `ahead`: where the last forces were taken [s]

  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int site) const {
    const TouchingPoints<B>& points = law.points;
    double count = 0;
    for (int row = 0; row < points.rows_of(site); ++row) {
      const int r = points.record(row, site);
      Vec3<Real> more;
      if (points.near(r)) {
        const Vec3<Real> dv = points.difference(surface, change, row, site);
        const bool touched = points.is_stiff(r);
        more = block_at<B>(points.block, r) * dv - law.b * law.at(row, site, law.ahead).force;
        move(row, site, dv);
        const auto there = law.at(row, site, Real(0));
        more += law.b * there.force;
        set_block<B>(points.block, r, there.block);
        count += touched || points.is_stiff(r) ? 1 : 0;
      }
      set_vector<B>(points.force, r, more);
    }
    return {{count}};
  }

 private:
  KOKKOS_INLINE_FUNCTION void move(int row, int site, const Vec3<Real>& dv) const {
    const TouchingPoints<B>& points = law.points;
    const int r = points.record(row, site);
    const Vec3<Real> N = vector_at<B>(points.normal, r), v = vector_at<B>(points.velocity, r);
    const Vec3<Real> way = law.ahead * v + (law.a / law.b) * dv;
    if (points.is_held(row, site)) {
      set_vector<B>(points.normal, r, N + way);
    } else {
      const Vec3<Real> turn = points.turn(r, way);
      points.depth(r) -= dot(N + Real(0.5) * turn, way);
      set_vector<B>(points.normal, r, law.turned(r, turn));
    }
    set_vector<B>(points.velocity, r, v + dv);
  }
};

/// The force of each record is its block times what a field has there. `beside`: of those alone that are in no matrix.
template <class B>
struct ContactProduct {
  EmbeddedSurface<B> surface;
  Vectors<B> x;
  TouchingPoints<B> points;
  bool beside;

  KOKKOS_INLINE_FUNCTION void operator()(int site) const {
    for (int row = 0; row < points.rows_of(site); ++row) {
      const int r = points.record(row, site);
      Vec3<typename B::Real> force;
      if (points.is_stiff(r) && !(beside && points.is_of_one(row, site)))
        force = block_at<B>(points.block, r) * points.difference(surface, x, row, site);
      set_vector<B>(points.force, r, force);
    }
  }
};

/// Adds the vertex blocks of W^T C W, [vertices][6]: of a vertex, those of all records that its points have a part in.
template <class B>
struct AddContactBlocks {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  TouchingPoints<B> points;
  bool beside;  ///< see ContactProduct
  Blocks<B> diagonal;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = surface.vertex(i);
    SymMat3<Real> sum = block_at<B>(diagonal, a);
    for (int s = surface.first(i); s < surface.first(i + 1); ++s) {
      const int q = surface.point(s);
      const Real w = surface.weight(s);
      for (int row = beside ? points.obstacles : 0; row < points.rows_of(q); ++row)
        add(sum, a, row, q, row < points.obstacles ? w : w * points.pairs.own_weight(points.pair(row, q)));
      if (points.pairs.triangles > 0)
        points.pairs.each_pair_at(q, [&](int pair, Real weight) {
          add(sum, a, points.obstacles + pair / points.points, pair % points.points, w * weight);
        });
      if (points.faces.triangles > 0) add_faces(sum, a, q, w);
    }
    set_block<B>(diagonal, a, sum);
  }

  /// sum += part * (all that the vertex has of the site) * block
  KOKKOS_INLINE_FUNCTION void add(SymMat3<Real>& sum, int a, int row, int site, Real part) const {
    const int r = points.record(row, site);
    if (points.is_stiff(r)) add_scaled(sum, part * points.share(surface, row, site, a), block_at<B>(points.block, r));
  }
  KOKKOS_INLINE_FUNCTION void add_faces(SymMat3<Real>& sum, int a, int q, Real w) const {
    const FaceSites<B>& faces = points.faces;
    for (int s = faces.first(q); s < faces.first(q + 1); ++s)
      for (int o = 0; o < points.obstacles; ++o)
        add(sum, a, o, points.points + faces.triangle(s), w * faces.weight_of(o, faces.triangle(s), q));
  }
};

/// A += scale W^T C W of points that touch obstacles: a row of A per work item, its points in order, the blocks that are stored in it. Vertices of
/// one tetrahedron are coupled in A already, unless the row's motion is given.
template <class B>
struct AddContactToMatrix {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  TouchingPoints<B> points;
  Real scale;
  BlockMatrix<B> A;

  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const int a = surface.vertex(item), first = A.first(a), last = A.first(a + 1);
    for (int s = surface.first(item); s < surface.first(item + 1); ++s) {
      const int p = surface.point(s);
      SymMat3<Real> C{};
      for (int o = 0; o < points.obstacles; ++o)
        if (const int r = points.record(o, p); points.is_stiff(r)) add_scaled(C, Real(1), block_at<B>(points.block, r));
      for (int c = 0; c < 4; ++c) {
        int at = first;
        while (at < last && A.column(at) != surface.embedding.source(p, c)) ++at;
        if (at == last || !A.is_stored(a, at)) continue;
        const Real w = scale * surface.weight(s) * surface.embedding.weight(p, c);
        add_block<B>(A, at, w, C);
      }
    }
  }
};

}  // namespace plica
