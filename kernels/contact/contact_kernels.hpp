// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/reduce.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Sets vectors to 0.
template <class B>
struct ZeroVectors {
  Vectors<B> x;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { set_vector<B>(x, a, {}); }
};

/// Computes the positions of the surface points, and the largest square of a point's velocity.
template <class B>
struct PlacePoints {
  EmbeddedSurface<B> surface;
  State<B> state;
  Vectors<B> places;
  KOKKOS_INLINE_FUNCTION Sums<1, 1> operator()(int p) const {
    set_vector<B>(places, p,
                  value_at<B>(surface.embedding, state.u, p, vector_at<B>(surface.rest, p)));
    const auto v = value_at<B>(surface.embedding, state.v, p);
    return {{static_cast<double>(dot(v, v))}};
  }
};

/// Adds the transpose of the embedding times the point forces to f. Each vertex adds its points in
/// order.
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

template <class B>
void scatter_to_vertices(const typename B::Exec& exec, const EmbeddedSurface<B>& surface,
                         const Vectors<B>& force, const Vectors<B>& f) {
  update_vertices<B>(exec, "plica::scatter_to_vertices", surface.touched,
                     ScatterToVertices<B>{surface, force, f});
}

/// Returns the part of an acceleration that mass damping leaves; see ContactStep.
template <class B>
KOKKOS_INLINE_FUNCTION typename B::Real kept(const VertexModel<B>& model, int a,
                                             typename B::Real damped) {
  return 1 / (1 + damped * model.damping(a));
}

/// Adds W^T F to f. Each vertex adds its records in order.
template <class B>
struct ScatterContact {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  ContactRecords<B> records;
  Vectors<B> f;
  Real factor = 1;  ///< factor of the forces
  VertexModel<B> model = {};
  Real damped = 0;  ///< factor of mass damping [s]; see ContactStep
  AbsoluteWeights absolute_weights = AbsoluteWeights::none;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = surface.vertex(records.transpose.vertices.item(i));
    const Real part = damped > 0 ? factor * kept<B>(model, a, damped) : factor;
    set_vector<B>(f, a, vector_at<B>(f, a) + part * contact_force<B>(records, i, absolute_weights));
  }
};

/// Force of a record in a state that stays: the force of its springs.
template <class B>
struct StaticContact {
  ContactRecords<B> records;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    using Real = typename B::Real;
    const int r = records.list.item(i);
    const ContactLaw<Real> law = records.law_at(r);
    const Vec3<Real> s = vector_at<B>(records.stretch, r);
    const Real lam =
        law.is_tie() ? Real(0) : law.stiffness * Kokkos::max(Real(0), records.depth(r));
    const Vec3<Real> q = at_most((law.is_tie() ? law.stiffness : law.shear_stiffness) * s,
                                 law.is_tie() ? law.strength : law.friction * lam);
    set_vector<B>(records.force, r, lam * vector_at<B>(records.normal, r) - q);
  }
};

/// Record at a state that is `since` [s] after the state at which it was found.
template <class B>
struct RecordLater {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> v;
  ContactRecords<B> records;
  Real since, span;  ///< span: duration of the step whose way the record has [s]

  KOKKOS_INLINE_FUNCTION Real depth(int r) const {
    if (records.law_at(r).is_tie()) return -records.nowhere();
    return records.depth(r) - dot(vector_at<B>(records.normal, r), way(r));
  }
  /// Returns the way of a record against its partner since it was found [m].
  KOKKOS_INLINE_FUNCTION Vec3<Real> way(int r) const {
    if (!(since > 0)) return {};
    return since * records.value(surface, v, r) - (since / span) * vector_at<B>(records.way, r);
  }
};

/// Energy stored in a record's spring and in its stretch [J]. Sweeps that have not converged are a
/// softer spring, whose energy is its force times its depth over 2; damping adds nothing to it.
template <class B>
struct ContactEnergy {
  RecordLater<B> at;
  bool by_force;  ///< false: of the law's spring at this depth, whatever the force
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    const int r = at.records.list.item(i);
    const auto& law = at.records.law_at(r);
    const auto s = vector_at<B>(at.records.stretch, r), force = vector_at<B>(at.records.force, r);
    if (law.is_tie()) {
      const auto now = s + at.way(r);
      const double spring = static_cast<double>(law.stiffness * dot(now, now)),
                   pull = -static_cast<double>(dot(force, now));
      return {{0.5 * (by_force ? Kokkos::min(spring, Kokkos::max(0.0, pull)) : spring)}};
    }
    const double depth = Kokkos::max(0.0, static_cast<double>(at.depth(r))),
                 lam = static_cast<double>(dot(force, vector_at<B>(at.records.normal, r)));
    const double spring = static_cast<double>(law.stiffness) * depth,
                 push = by_force ? Kokkos::min(spring, Kokkos::max(0.0, lam)) : spring;
    return {{0.5 * push * depth + 0.5 * Kokkos::max(0.0, -static_cast<double>(dot(force, s)))}};
  }
};

/// Depth of a record's site in its partner [m], for records of row `row`. A triangle's record has
/// only the depth beyond its corners, so that their depths are added.
template <class B>
struct DepthInPartner {
  RecordLater<B> at;
  int row;
  KOKKOS_INLINE_FUNCTION Sums<1, 1> operator()(int i) const {
    const ContactRecords<B>& records = at.records;
    const int r = records.list.item(i);
    if (Kokkos::min(records.row(r), records.obstacles) != row) return {};
    double depth = static_cast<double>(at.depth(r));
    if (!(depth > 0)) return {};
    for (int c = 0; records.is_on_face(r) && c < 3; ++c)
      if (const int corner = records.of_point(row, records.point(r, c)); records.near(corner) > 0)
        depth += static_cast<double>(records.weight(r, c)) *
                 Kokkos::max(0.0, static_cast<double>(at.depth(corner)));
    return {{depth}};
  }
};

}  // namespace plica
