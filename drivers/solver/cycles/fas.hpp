// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/cycles/cycle.hpp>
#include <plica/kernels/transfer/map_state.hpp>
#include <plica/kernels/transfer/restrict_state.hpp>

namespace plica {

/// A V-cycle whose coarse levels strive for the finest level's equilibrium, not their own: each carries the constant force
/// tau = P^T (the finer level's force) - (its own), both at the state the cycle starts from, after the full approximation
/// scheme (Brandt 1977). Restriction is the adjoint of the interpolation, coarse masses are inherited from the finer ones:
/// mass and linear momentum pass exactly. State down, variation up.
///
/// Not symplectic: its linearised map has a spectral radius a little above 1 at every macro step with explicit levels.
template <class B>
class FasCycle final : public Cycle<B> {
 public:
  explicit FasCycle(Hierarchy<B>& h) : correction_(h.levels.size()) {
    for (int i = 1; i < h.count(); ++i) {
      const int n = h[i].level.model.vertices;
      h[i].level.start = State<B>("start", n);
      correction_[static_cast<std::size_t>(i)] = Vectors<B>("plica::correction", n);
    }
  }

  void begin(Hierarchy<B>& h) override {
    for (int i = 1; i < h.count(); ++i) restrict_state(h, i);
  }

  void step(Hierarchy<B>& h, double time, double t) override {
    if (h.count() > 1) {
      prescribe_levels(h, time);
      h[0].forces->evaluate(h[0].level, h[0].level.state, time, h[0].level.f);
    }
    for (int i = 1; i < h.count(); ++i) {
      restrict_state(h, i);
      correct(h, i, time);
    }
    for (int i = h.count() - 1; i >= 0; --i) {
      if (i + 1 < h.count()) interpolate_variation(h, i);
      time = integrate(h, i, time, t);
    }
  }

 private:
  std::vector<Vectors<B>> correction_;

  static void restrict_state(Hierarchy<B>& h, int i) {
    const Level<B>&fine = h[i - 1].level, &coarse = h[i].level;
    h.clock.time("restrict", i, [&] {
      update_vertices<B>(h.exec(), "plica::restrict", coarse.model.vertices,
                         RestrictState<B>{coarse.adjoint, fine.state, coarse.state, coarse.model.inverse_mass});
      coarse.start.copy(h.exec(), coarse.state);
    });
  }

  /// Leaves in level.f the level's corrected force at this state, for the next coarser level.
  void correct(Hierarchy<B>& h, int i, double time) {
    const Level<B>&fine = h[i - 1].level, &coarse = h[i].level;
    const Vectors<B>& tau = correction_[static_cast<std::size_t>(i)];
    LevelForces<B>& forces = *h[i].forces;
    forces.set_correction({});
    forces.evaluate(coarse, coarse.state, time, coarse.f);
    h.clock.time("correct", i, [&] {
      update_vertices<B>(h.exec(), "plica::correction", coarse.model.vertices,
                         DefectCorrection<B>{coarse.adjoint, fine.f, fine.model.inverse_mass, coarse.model.inverse_mass,
                                             coarse.f, tau});
    });
    forces.set_correction(tau);
    forces.add_correction(coarse.f);
  }

  static void interpolate_variation(Hierarchy<B>& h, int i) {
    const Level<B>&fine = h[i].level, &coarse = h[i + 1].level;
    h.clock.time("interpolate", i, [&] {
      map_fields<B, MapVariation>(h.exec(), "plica::interpolate", coarse.to_finer, coarse.state, coarse.start,
                                  fine.state, fine.state, {});
    });
  }
};

}  // namespace plica
