// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/him/coarse_frames.hpp>

// Step of the hierarchical inverse mass on the finest level: drift by half a step, kick of the
// momenta, v = A p, drift by half a step; see KickMomentum.
namespace plica {

/// Factor c of this step by which KickMomentum reduces p - m v. It is given, or 0.3 times the root
/// mean square of the angles by which the coarsest frames turned in the last step, at most 1e-4.
template <class B>
struct DetailDissipation {
  Doubles<B> turned;  ///< mean square of the angles [rad^2]
  double given;       ///< c, or < 0: chosen from the angles
  KOKKOS_INLINE_FUNCTION double operator()() const {
    return given >= 0 ? given : Kokkos::min(1e-4, 0.3 * Kokkos::sqrt(turned(0)));
  }
};

/// Rigid motion about the body's present centre, in double.
struct RigidFrame {
  double centre[3];
  double linear[3], angular[3];  ///< [m/s], [rad/s]
};

template <class B>
using RigidFrameOf = Kokkos::View<RigidFrame, typename B::Memory>;

KOKKOS_INLINE_FUNCTION Vec3<double> vector_of(const double* x) { return {x[0], x[1], x[2]}; }

/// Velocities of a rigid motion at the body's vertices; 0 where there is none.
template <class B>
struct RigidMotion {
  using Real = typename B::Real;
  Vectors<B> rest, u;
  RigidFrameOf<B> frame;
  KOKKOS_INLINE_FUNCTION Vec3<Real> operator()(int a) const {
    if (rest.extent(0) == 0) return {};
    Vec3<double> x;
    for (int k = 0; k < 3; ++k)
      x[k] = static_cast<double>(rest(a, k)) + static_cast<double>(u(a, k)) - frame().centre[k];
    const Vec3<double> v = vector_of(frame().linear) + cross(vector_of(frame().angular), x);
    return {static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2])};
  }
};

/// Contact's forces on the vertices. They are 0 where nothing touches. Without obstacles, the
/// arrays are empty and the forces are 0.
template <class B>
struct ContactForces {
  Vectors<B> force;
  Doubles<B> touching;  ///< number of places that touch, on the device
  KOKKOS_INLINE_FUNCTION bool any() const { return force.extent(0) > 0 && touching(0) > 0; }
  KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> operator()(int a) const {
    return any() ? vector_at<B>(force, a) : Vec3<typename B::Real>{};
  }
};

/// Kicks the momenta: p = ((1 - t d / 2) p + t f - c (p - m v)) / (1 + t d / 2), d the mass
/// damping. Where the body is free, p - m v is taken without its rigid part, so that c changes
/// neither sum p nor sum x x p. Contact's forces of the last step are among f: the force of frames
/// should be found for the momenta at the end of the step, see TakeExpectedContact.
template <class B>
struct KickMomentum {
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> f, v, p;
  ContactForces<B> contact;  ///< forces of the last step
  RigidMotion<B> rigid;      ///< rigid part of p - m v
  DetailDissipation<B> loss;
  Real t;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    if (!(model.inverse_mass(a) > 0)) return;
    const Real c = static_cast<Real>(loss()), m = model.mass(a),
               half_damping = t * model.damping(a) / 2, kept = 1 / (1 + half_damping);
    const Vec3<Real> whole = rigid(a), touch = contact(a);
    for (int k = 0; k < 3; ++k) {
      const Real slowed = p(a, k) - m * v(a, k) - m * whole[k];
      p(a, k) = kept * ((1 - half_damping) * p(a, k) + t * f(a, k) - c * slowed) + t * touch[k];
    }
  }
};

/// Removes the expected contact from momenta and accelerations.
template <class B>
struct TakeExpectedContact {
  using Real = typename B::Real;
  Scalars<B> inverse_mass;
  Vectors<B> force, answer;  ///< expected forces, and the response to them
  Vectors<B> p, a;
  Real t;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    if (!(inverse_mass(i) > 0)) return;
    set_vector<B>(p, i, vector_at<B>(p, i) - t * vector_at<B>(force, i));
    set_vector<B>(a, i, vector_at<B>(a, i) - vector_at<B>(answer, i));
  }
};

/// Kicks the velocities, adds contact's part to velocities and momenta, and makes the second drift.
/// Sums up t^2 da.df and -dx.df for WatchStability, d: change since the last step.
template <class B>
struct KickAndDrift {
  using Real = typename B::Real;
  Scalars<B> inverse_mass;
  State<B> state;
  Vectors<B> p, f, a, f_before, a_before;
  ContactForces<B> contact;
  Vectors<B> contact_answer;  ///< accelerations by contact's forces
  Real t;
  KOKKOS_INLINE_FUNCTION Sums<2> operator()(int i) const {
    if (!(inverse_mass(i) > 0)) return {};
    const bool touches = contact.any();
    const Vec3<Real> v = vector_at<B>(state.v, i), force = vector_at<B>(f, i),
                     answer = vector_at<B>(a, i), df = force - vector_at<B>(f_before, i),
                     da = answer - vector_at<B>(a_before, i), u = vector_at<B>(state.u, i);
    const Vec3<Real> kicked = v + t * (touches ? answer + vector_at<B>(contact_answer, i) : answer);
    if (touches) set_vector<B>(p, i, vector_at<B>(p, i) + t * contact(i));
    set_vector<B>(f_before, i, force), set_vector<B>(a_before, i, answer);
    set_vector<B>(state.v, i, kicked), set_vector<B>(state.u, i, u + Real(0.5) * t * kicked);
    double answered = 0, work = 0;
    for (int k = 0; k < 3; ++k) {
      answered += static_cast<double>(t * t * da[k]) * static_cast<double>(df[k]);
      work -= static_cast<double>(t * v[k]) * static_cast<double>(df[k]);
    }
    return {{answered, work}};
  }
};

/// Watches t^2 da.df / (-dx.df), a mean of t^2 times the eigenvalues of A K over the last step's
/// motion. Stability is lost at 4; then the fastest motions take over, and with them the mean.
/// `state` has three numbers: how often running the mean was above 3.4; 1 where that was twice or a
/// sum is not finite, 2 where the force of frames was not found (to 1 %, see FrameRound); the
/// largest mean.
template <class B>
struct WatchStability {
  Doubles<B> sums, state;
  FrameRound<B> last;
  bool first;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    const double answer = sums(0), work = sums(1);
    const bool counts = !first && work > 0;
    if (counts) state(2) = Kokkos::max(state(2), answer / work);
    state(0) = counts && answer > 3.4 * work ? state(0) + 1 : 0.0;
    const bool lost = last.sums.extent(0) > 0 && last.change() > 0.01;
    if (state(0) >= 2 || !(answer - answer == 0)) state(1) = 1;
    if (lost) state(1) = 2;
  }
};

/// Ends a step after its sums: watches the spectrum, and sets the mean square of the angles.
template <class B>
struct EndOfStep {
  WatchStability<B> watch;
  Doubles<B> angles, turned;  ///< see FrameFields and Loss
  int frames;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    watch();
    double sum = 0;
    for (std::size_t i = 0; i < angles.extent(0); ++i) sum += angles(i);
    turned(0) = frames > 0 ? sum / frames : 0;
  }
};

// Translation of a free body, computed exactly, so that sum m v is sum p whatever A is; and the
// rigid part of momenta.

/// Sums m, m x, m x x^T (xx yy zz xy xz yz) about the placed mesh's origin, and the sum and moment
/// of p - m v: 16 sums.
template <class B>
struct BodyMoments {
  Scalars<B> mass;
  Vectors<B> rest, u, p, v;
  KOKKOS_INLINE_FUNCTION Sums<16> operator()(int a) const {
    Vec3<double> x, part;
    for (int k = 0; k < 3; ++k) {
      x[k] = static_cast<double>(rest(a, k)) + static_cast<double>(u(a, k));
      part[k] = static_cast<double>(p(a, k) - mass(a) * v(a, k));
    }
    const double m = static_cast<double>(mass(a));
    const Vec3<double> moment = cross(x, part);
    return {{m, m * x[0], m * x[1], m * x[2], m * x[0] * x[0], m * x[1] * x[1], m * x[2] * x[2],
             m * x[0] * x[1], m * x[0] * x[2], m * x[1] * x[2], part[0], part[1], part[2],
             moment[0], moment[1], moment[2]}};
  }
};

/// Computes the centre and the rigid motion from the sums of BodyMoments. A body on one line does
/// not turn.
template <class B>
struct SetRigidFrame {
  Doubles<B> sums;
  RigidFrameOf<B> frame;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    RigidFrame& r = frame();
    const double m = sums(0);
    Vec3<double> c{sums(1) / m, sums(2) / m, sums(3) / m}, P{sums(10), sums(11), sums(12)};
    const double xx = sums(4) - m * c[0] * c[0], yy = sums(5) - m * c[1] * c[1],
                 zz = sums(6) - m * c[2] * c[2], xy = sums(7) - m * c[0] * c[1],
                 xz = sums(8) - m * c[0] * c[2], yz = sums(9) - m * c[1] * c[2];
    const Mat3<double> inertia{Vec3<double>{yy + zz, -xy, -xz}, Vec3<double>{-xy, xx + zz, -yz},
                               Vec3<double>{-xz, -yz, xx + yy}};
    const double det = determinant(inertia), size = trace(inertia);
    const Mat3<double> inverse =
        (det > 1e-12 * size * size * size ? 1 / det : 0.0) * transpose(cofactor(inertia));
    const Vec3<double> moment = Vec3<double>{sums(13), sums(14), sums(15)} - cross(c, P),
                       angular = inverse * moment;
    for (int k = 0; k < 3; ++k)
      r.centre[k] = c[k], r.linear[k] = P[k] / m, r.angular[k] = angular[k];
  }
};

/// Sums m and p.
template <class B>
struct SumOfMomenta {
  Scalars<B> mass;
  Vectors<B> p;
  KOKKOS_INLINE_FUNCTION Sums<4> operator()(int a) const {
    return {{static_cast<double>(mass(a)), static_cast<double>(p(a, 0)),
             static_cast<double>(p(a, 1)), static_cast<double>(p(a, 2))}};
  }
};

/// Kicks the momenta, and sums up the result.
template <class B>
struct KickAndSum {
  KickMomentum<B> kick;
  KOKKOS_INLINE_FUNCTION Sums<4> operator()(int a) const {
    kick(a);
    return SumOfMomenta<B>{kick.model.mass, kick.p}(a);
  }
};

/// Sums m and m v.
template <class B>
struct SumOfMotion {
  Scalars<B> mass;
  Vectors<B> v;
  KOKKOS_INLINE_FUNCTION Sums<4> operator()(int a) const {
    const double m = static_cast<double>(mass(a));
    return {{m, m * static_cast<double>(v(a, 0)), m * static_cast<double>(v(a, 1)),
             m * static_cast<double>(v(a, 2))}};
  }
};

/// Computes rest = p - m (sum p / sum m), the momenta without the translation.
template <class B>
struct TakeTranslation {
  using Real = typename B::Real;
  Scalars<B> mass;
  Vectors<B> p, rest;
  Doubles<B> sums;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k)
      rest(a, k) = p(a, k) - mass(a) * static_cast<Real>(sums(k + 1) / sums(0));
  }
};

/// Adds a translation to v, so that its mean is that of the momenta.
template <class B>
struct PutTranslation {
  using Real = typename B::Real;
  Vectors<B> v;
  Doubles<B> wanted, sums;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k)
      v(a, k) += static_cast<Real>((wanted(k + 1) - sums(k + 1)) / sums(0));
  }
};

/// Adds a translation to v, and computes the mean acceleration that follows.
template <class B>
struct AccelerationOfTranslated {
  PutTranslation<B> put;
  MeanAcceleration<B> mean;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { put(a), mean(a); }
};

}  // namespace plica
