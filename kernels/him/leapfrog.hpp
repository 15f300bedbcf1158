// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/vectors.hpp>

// One step of the hierarchical inverse mass on the finest level: drift by half a step, kick the momenta, v = A p, drift by half
// a step; see KickMomentum.
namespace plica {

/// c of this step: given, or 0.3 times the root mean square of the angles by which the coarsest axes turn, at most 1e-4.
template <class B>
struct ChooseLoss {
  Doubles<B> moved, loss;
  double given;  ///< < 0: chosen
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    const double angle = moved(1) > 0 ? Kokkos::sqrt(moved(0) / moved(1)) : 0.0;
    loss(0) = given >= 0 ? given : Kokkos::min(1e-4, 0.3 * angle);
  }
};

/// p = ((1 - t d / 2) p + t f - c g) / (1 + t d / 2), d the mass damping; no g: p - m v
template <class B>
struct KickMomentum {
  using Real = typename B::Real;
  Model<B> model;
  Vectors<B> f, v, g, p;
  Doubles<B> loss;
  Real t;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    if (!(model.inverse_mass(a) > 0)) return;
    const Real c = static_cast<Real>(loss(0)), m = model.mass(a), half_damping = t * model.damping(a) / 2;
    for (int k = 0; k < 3; ++k) {
      const Real slowed = g.extent(0) > 0 ? g(a, k) : p(a, k) - m * v(a, k);
      p(a, k) = ((1 - half_damping) * p(a, k) + t * f(a, k) - c * slowed) / (1 + half_damping);
    }
  }
};

/// answer = (answer - v) / t: from A p to the acceleration.
template <class B>
struct MeanAcceleration {
  using Real = typename B::Real;
  Vectors<B> v, answer;
  Real per_step;  ///< 1/t
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) answer(a, k) = (answer(a, k) - v(a, k)) * per_step;
  }
};

/// The kick of the velocities, contact's of both, and the second drift; sums up t^2 da.df and -dx.df of the guard, d: since the
/// last step.
template <class B>
struct KickAndDrift {
  using Real = typename B::Real;
  Scalars<B> inverse_mass;
  State<B> state;
  Vectors<B> p, f, a, f_before, a_before;
  Vectors<B> contact, contact_force;  ///< its accelerations and forces, empty without obstacles
  Doubles<B> touching;
  Real t;
  KOKKOS_INLINE_FUNCTION Sums<2> operator()(int i) const {
    if (!(inverse_mass(i) > 0)) return {};
    const bool touches = contact.extent(0) > 0 && touching(0) > 0;
    double answer = 0, work = 0;
    for (int k = 0; k < 3; ++k) {
      const Real v = state.v(i, k), df = f(i, k) - f_before(i, k),
                 kicked = v + t * (touches ? a(i, k) + contact(i, k) : a(i, k));
      if (touches) p(i, k) += t * contact_force(i, k);
      answer += static_cast<double>(t * t * (a(i, k) - a_before(i, k))) * static_cast<double>(df);
      work -= static_cast<double>(t * v) * static_cast<double>(df);
      f_before(i, k) = f(i, k), a_before(i, k) = a(i, k);
      state.v(i, k) = kicked;
      state.u(i, k) += Real(0.5) * t * kicked;
    }
    return {{answer, work}};
  }
};

/// Watches t^2 da.df / (-dx.df), a mean of t^2 times the eigenvalues of A K over what the last step did: as stability is lost at
/// 4 the fastest motions take over, and with them the mean. `state`: how often running it was above 3.4, 1 where that was twice,
/// 2 where the axes' force was not found (to 1 %, see DecideToGoOn), the largest.
template <class B>
struct WatchSpectrum {
  Doubles<B> sums, open, state;
  bool first;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    const double answer = sums(0), work = sums(1);
    const bool counts = !first && work > 0;
    if (counts) state(2) = Kokkos::max(state(2), answer / work);
    state(0) = counts && answer > 3.4 * work ? state(0) + 1 : 0.0;
    const bool lost = open.extent(0) > 0 && open(0) > 0.01;
    if (state(0) >= 2 || !(answer - answer == 0)) state(1) = 1;
    if (lost) state(1) = 2;
  }
};

}  // namespace plica
