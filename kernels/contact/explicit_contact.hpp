// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/reduce.hpp>

// Contact in an explicit step of h and in `him`. It is implicit in the acceleration of that step,
// so that its stiffness does not bound the step. With e the acceleration without contact and r the
// one by contact, D = h v + h^2 W (e + r) less the obstacle's way. The law (see contact_law.hpp) is
// solved by sweeps of projected Jacobi from 0:
//
//   lam <- max(0, lam + (kn (d0 - N.D - d*) - lam) / (1 + h^2 kn rho))
//   q   <- q + (kt' x - q) / (1 + h^2 kt' rho), at most mu lam
//
// Records are coupled by A, the inverse mass: r = A W^T F. The relaxation of a record is by rho,
// the sum of its row of W A W^T over the records that touch. It is exact for an even pressure, and
// never too much. For rho, W^T takes absolute weights, which bounds the sum.
//
//   records                                    vertices
//   1. unit force on each that touches  --W^T-->  f  --A-->  a  --W-->  r: gives rho
//   2. forces from e and the last r     --W^T-->  f  --A-->  a  --W-->  r      once for every sweep
//   3. stretches from the last r        s <- s + D across N, times tau/|q| where that is below 1
//
// Sweeps that have not converged do not creep: the stretch adds up the way that was gone until it
// holds, however little of its force the sweeps find. Why no number of sweeps takes stability away
// is in cmake/docs/explanation/contact.md.
namespace plica {

/// Data of a step for the sweeps.
template <class B>
struct ExplicitContact {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  ContactRecords<B> records;
  Vectors<B> v;
  /// Accelerations without contact, and by the last contact forces [m/s^2]
  Vectors<B> free, answer;
  Real h, ahead;
  /// True where A responds alike to a force of any direction: unit forces of one direction bound
  /// all rows of W A W^T
  bool isotropic;

  KOKKOS_INLINE_FUNCTION Vec3<Real> normal(int r) const { return vector_at<B>(records.normal, r); }
  /// Returns the depth at the end of a step with way D [m].
  KOKKOS_INLINE_FUNCTION Real end(int r, const Vec3<Real>& D) const {
    return records.depth(r) - dot(normal(r), D);
  }
  /// Returns x of the law for way D, which gives the tangential force; for a tie it acts in all
  /// directions.
  KOKKOS_INLINE_FUNCTION Vec3<Real> shear(const LawOfStep<Real>& law, int r,
                                          const Vec3<Real>& D) const {
    return across(D, normal(r)) + law.memory * vector_at<B>(records.stretch, r);
  }
  /// Returns the unit force that finds rho where forces may have any direction. Its response is no
  /// less than 1/sqrt 3 of the largest.
  KOKKOS_INLINE_FUNCTION Vec3<Real> any_direction() const {
    if (isotropic) return {Real(1), Real(0), Real(0)};
    const Real part = Real(0.57735027);
    return {part, part, part};
  }
};

/// Computes the way without contact, puts a unit force on every record that touches, and counts
/// these records.
template <class B>
struct StartContact {
  using Real = typename B::Real;
  ExplicitContact<B> step;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    const ContactRecords<B>& records = step.records;
    const int r = records.list.item(i);
    const Vec3<Real> N = step.normal(r), last = vector_at<B>(records.force, r);
    const Vec3<Real> way =
        step.h * records.value(step.surface, step.v, r) - vector_at<B>(records.way, r);
    const Vec3<Real> D = way + step.h * step.h * records.value(step.surface, step.free, r);
    if (step.ahead > 0) records.depth(r) -= step.ahead / step.h * dot(N, way);
    set_vector<B>(records.drift, r, D);
    records.response(r) = 0;
    const ContactLaw<Real> law = records.law_at(r);
    Vec3<Real> unit;
    if (law.is_tie())
      unit = step.any_direction();
    else if (LawOfStep<Real>(law, step.h).pressure(records.depth(r), step.end(r, D)) > 0 ||
             dot(last, N) > 0)
      unit = step.isotropic ? step.any_direction() : N;
    set_vector<B>(records.force, r, unit);
    return {{dot(unit, unit) > 0 ? 1.0 : 0.0}};
  }
};

/// One sweep. The first sweep finds the response to the unit forces, without contact forces.
template <class B>
struct SweepContact {
  using Real = typename B::Real;
  ExplicitContact<B> step;
  bool first;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const ContactRecords<B>& records = step.records;
    const int r = records.list.item(i);
    const Vec3<Real> force = vector_at<B>(records.force, r);
    if (!(first ? dot(force, force) > 0 : records.response(r) > 0)) return;
    const Vec3<Real> answer = records.value(step.surface, step.answer, r,
                                            first && (step.isotropic || !records.is_pair(r)));
    Vec3<Real> D = vector_at<B>(records.drift, r);
    if (first) {
      constexpr Real smallest = Kokkos::Experimental::norm_min_v<Real>;
      records.response(r) = Kokkos::max(Kokkos::sqrt(dot(answer, answer)), smallest);
    } else {
      D += step.h * step.h * answer;
    }
    set_vector<B>(records.force, r, swept(r, first ? Vec3<Real>{} : force, D));
  }

  /// Stiffness of a fast record, over h^2 rho: it leaves 1/17 of a way into the partner
  static constexpr Real stop = 16;
  /// Part of its way by which a fast record is stopped before the partner, since sweeps are few
  static constexpr Real early = Real(0.2);
  /// Returns true for a record that is outside and would end an edge inside. It is stopped in this
  /// step, however soft its law.
  KOKKOS_INLINE_FUNCTION bool comes_in_fast(int r) const {
    constexpr Real fast = 1;
    return !(step.records.depth(r) > 0) &&
           step.end(r, vector_at<B>(step.records.drift, r)) > fast * step.records.edge;
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> swept(int r, const Vec3<Real>& force,
                                          const Vec3<Real>& D) const {
    const ContactLaw<Real> of = step.records.law_at(r);
    const LawOfStep<Real> law(of, step.h);
    const Vec3<Real> N = step.normal(r);
    const Real give = step.h * step.h * step.records.response(r), before = dot(force, N);
    Real lam = 0, cap = of.strength;
    if (!of.is_tie()) {
      const bool fast = comes_in_fast(r);
      const Real stiffer = fast ? Kokkos::max(Real(1), stop / (give * law.kn)) : Real(1);
      const Real margin = fast ? early * step.end(r, vector_at<B>(step.records.drift, r)) : Real(0);
      const Real wanted = stiffer * law.pressure(step.records.depth(r), step.end(r, D) + margin);
      lam = Kokkos::max(Real(0), before + (wanted - before) / (1 + give * stiffer * law.kn));
      cap = of.friction * lam;
    }
    Vec3<Real> q = before * N - force;
    q += (1 / (1 + give * law.kt)) * (law.kt * step.shear(law, r, D) - q);
    return lam * N - at_most(q, cap);
  }
};

/// Updates the carried stretches after a step whose forces are the last ones. The stretches follow
/// the step's way, and slip at the cap. Returns the work of friction [J].
template <class B>
struct StretchContact {
  using Real = typename B::Real;
  ExplicitContact<B> step;
  /// duration of the step itself, of which h may be more; see ContactResponse::set_part()
  Real span;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    const ContactRecords<B>& records = step.records;
    const int r = records.list.item(i);
    const ContactLaw<Real> law = records.law_at(r);
    if (law.is_tie()) return {};
    const Vec3<Real> N = step.normal(r), force = vector_at<B>(records.force, r);
    const Real cap = records.response(r) > 0 ? law.friction * dot(force, N) : Real(0);
    if (!(cap > 0)) {
      set_vector<B>(records.stretch, r, {});
      return {};
    }
    const Real part = span / step.h;
    // the way of a step of part h, part h (v + part h (e + r)), from the numbers of h
    const Vec3<Real> way =
        step.h * records.value(step.surface, step.v, r) - vector_at<B>(records.way, r);
    const Vec3<Real> by_force = vector_at<B>(records.drift, r) - way +
                                step.h * step.h * records.value(step.surface, step.answer, r);
    const Vec3<Real> D = part * (way + part * by_force);
    // the force of another sweep: beyond the cap the contact slips, in proportion
    const LawOfStep<Real> of(law, step.h);
    const Vec3<Real> q = dot(force, N) * N - force;
    const Vec3<Real> wanted = of.kt * step.shear(of, r, way + by_force);
    const Vec3<Real> next =
        q + (1 / (1 + step.h * step.h * records.response(r) * of.kt)) * (wanted - q);
    const Real size = Kokkos::sqrt(dot(next, next));
    const Vec3<Real> s = vector_at<B>(records.stretch, r) + across(D, N);
    set_vector<B>(records.stretch, r, size > cap ? (cap / size) * s : s);
    return {{-static_cast<double>(dot(q, D))}};
  }
};

// Kernels for an A that is the lumped masses' inverse. Contact acts on the vertices that have a
// part in the records in use, and on no other.

/// Computes e = (f/m - c v) / (1 + damped c); 0 where the motion is given.
template <class B>
struct FreeAcceleration {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  ContactTranspose<B> of;
  VertexModel<B> model;
  Vectors<B> f, v, e;
  Real damped;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = surface.vertex(of.vertices.item(i));
    const Real w = model.inverse_mass(a), c = model.damping(a),
               part = w > 0 ? kept<B>(model, a, damped) : Real(0);
    for (int k = 0; k < 3; ++k) e(a, k) = part * (w * f(a, k) - c * v(a, k));
  }
};

/// Computes answer = m^-1 W^T force / (1 + damped c).
template <class B>
struct AnswerByMass {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  VertexModel<B> model;
  ContactRecords<B> records;
  Vectors<B> answer;
  Real damped;
  AbsoluteWeights absolute_weights;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = surface.vertex(records.transpose.vertices.item(i));
    set_vector<B>(answer, a,
                  (model.inverse_mass(a) * kept<B>(model, a, damped)) *
                      contact_force<B>(records, i, absolute_weights));
  }
};

}  // namespace plica
