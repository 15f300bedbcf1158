// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/problem.hpp>
#include <plica/core/type_list.hpp>

// The integrators by name, from which a scene's integration.integrator chooses, each with its order
// in time and its limit. This header has no kernels: each integrator's make() is in a source of its
// own, with its formulas.
namespace plica {

template <class B>
struct LevelData;
template <class B>
class Integrator;
template <class B>
struct IntegratorParts;

/// Stability limit of an integrator on u'' = -K u - D u', with K and D per mass. It is the largest
/// h with lambda_max(h^2 K + h radius D) <= radius^2. For symplectic Euler, whose limit is h^2 w^2
/// + 2 h c <= 4, that is exact. For a Runge-Kutta method it keeps h s within `radius` for all modes
/// e^(s t). A method that grows at every step undamped has |R|^2 = 1 + growth (h w)^power - h c; it
/// is stable where damping outweighs the growth. Implicit integrators have no such limit.
struct StabilityLimit {
  double radius = 0;  ///< radius of the limit; 0: no limit of this kind
  double growth = 0;  ///< factor of the growth at every step; 0: it does not grow
  int power = 0;      ///< exponent of h w in the growth, above 1
  /// the largest h c, where mass damping c is explicit; 0: damping is implicit and never a limit
  double damping = 0;
};

struct SymplecticEuler {
  static constexpr const char* name = "symplectic_euler";
  static constexpr const char* summary = "explicit, order 1, symplectic; h < 2/w";
  static constexpr int order = 1;
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.radius = 2};
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

struct CentralDifference {
  static constexpr const char* name = "central_difference";
  static constexpr const char* summary = "explicit, order 2, symplectic; h < 2/w";
  static constexpr int order = 2;
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.radius = 2};
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

/// Forward Euler, with |1 + h s|^2 = 1 - h c + h^2 w^2 for a mode e^(s t). Undamped, a mode grows
/// at every step. One with mass damping c is stable for h < c / w^2 and h < 2 / c.
struct ForwardEuler {
  static constexpr const char* name = "euler";
  static constexpr const char* summary = "explicit, order 1; undamped it grows at every step";
  static constexpr int order = 1;
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.growth = 1, .power = 2, .damping = 2};
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

/// Runge-Kutta method of order 2, with |R|^2 = 1 + (h w)^4/4 - h c. Undamped, a mode grows at every
/// step. One with mass damping c is stable for h^3 < 4 c/w^4 and h c < 2.
struct Rk2 {
  static constexpr const char* name = "rk2";
  static constexpr const char* summary =
      "explicit, order 2, two forces a step; undamped it grows at every step";
  static constexpr int order = 2;
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.growth = 0.25, .power = 4, .damping = 2};
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

/// Runge-Kutta method of order 4, stable for h < 2.83/w undamped; motion near that limit decays.
/// The radius 2.78 is that of the largest half disc in its stability region, so that it holds with
/// any damping (Hairer & Wanner II, IV.2).
struct Rk4 {
  static constexpr const char* name = "rk4";
  static constexpr const char* summary = "explicit, order 4, four forces a step; h < 2.78/w";
  static constexpr int order = 4;
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.radius = 2.78, .damping = 2.78};
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

struct ImplicitEuler {
  static constexpr const char* name = "implicit_euler";
  static constexpr const char* summary = "implicit, order 1, dissipative; no limit";
  static constexpr int order = 1;
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{};
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

struct Newmark {
  static constexpr const char* name = "newmark";
  static constexpr const char* summary =
      "implicit, order 2 (trapezoidal), keeps the energy of linear motion; no limit";
  static constexpr int order = 2;
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{};
  /// Returns true: it conserves energy on the linear problem.
  static constexpr bool conserves(const ImplicitOptions&) { return true; }
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

struct Bdf2 {
  static constexpr const char* name = "bdf2";
  static constexpr const char* summary =
      "implicit, order 2, little dissipation but of fast motion; no limit";
  static constexpr int order = 2;
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{};
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

struct Sdirk2 {
  static constexpr const char* name = "sdirk2";
  static constexpr const char* summary =
      "implicit, order 2, two solves a step, fast motion decays; no limit";
  static constexpr int order = 2;
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{};
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

struct GeneralizedAlpha {
  static constexpr const char* name = "generalized_alpha";
  static constexpr const char* summary =
      "implicit, order 2, damps fast motion by integration.implicit.rho_infinity; no limit";
  static constexpr int order = 2;
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{};
  /// Returns whether it conserves energy on the linear problem, where it damps no motion.
  static constexpr bool conserves(const ImplicitOptions& options) {
    return options.rho_infinity == 1.0;
  }
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

struct VCycleEuler {
  static constexpr const char* name = "v_cycle_euler";
  static constexpr const char* summary =
      "implicit, order 1: Euler by one V-cycle of multigrid per step; needs coarser levels";
  static constexpr int order = 1;
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{0.0};
  /// linear solver, whatever integration.implicit.solver says
  static constexpr const char* linear_solver = "v_cycle";
  template <class B>
  static std::unique_ptr<Integrator<B>> make(const LevelData<B>&, const IntegratorParts<B>&);
};

/// All integrators. A new one needs an entry above, its name here, and its source.
using Integrators = TypeList<SymplecticEuler, CentralDifference, ForwardEuler, Rk2, Rk4,
                             ImplicitEuler, Newmark, Bdf2, Sdirk2, GeneralizedAlpha, VCycleEuler>;

}  // namespace plica
