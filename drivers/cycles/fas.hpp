// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/cycles/shared_step.hpp>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/time/updates.hpp>
#include <plica/kernels/transfer/transfer.hpp>

namespace plica {

/// V-cycle whose coarse levels approach the finest level's equilibrium, not their own.
/// Each coarse level has a constant force tau = P^T (the finer level's force) - (its own), both at
/// the state that the cycle starts from, after the full approximation scheme (Brandt 1977). States
/// go down, variations go up. Restriction is the adjoint of the interpolation, and coarse masses
/// are restricted from the finer ones: mass and linear momentum pass exactly.
///
/// Not symplectic: its linearised map has a spectral radius a little above 1 at every macro step
/// with explicit levels.
template <class B>
class FasCycle final : public SharedStep<B> {
  using Base = SharedStep<B>;

 public:
  void begin(Hierarchy<B>& h) override {
    for (int i = 1; i < h.count(); ++i) restrict_state(h, i);
  }

  void step(Hierarchy<B>& h, double time, double t) override {
    if (h.count() > 1) {
      Base::prescribe_levels(h, time);
      h[0].evaluate(h[0].state, time, h[0].f, contact_of(h[0], t));
    }
    for (int i = 1; i < h.count(); ++i) {
      restrict_state(h, i);
      correct(h, i, time, t);
    }
    for (int i = h.count() - 1; i >= 0; --i) {
      if (i + 1 < h.count()) interpolate_variation(h, i);
      time = Base::integrate(h, i, time, t);
    }
  }

 private:
  std::vector<Vectors<B>> correction_;

  void allocate(Hierarchy<B>& h) override {
    correction_.resize(h.levels.size());
    for (int i = 1; i < h.count(); ++i) {
      const int n = h[i].model.vertices;
      h[i].start = State<B>("start", n);
      correction_[static_cast<std::size_t>(i)] = Vectors<B>("plica::correction", n);
    }
  }

  static void restrict_state(Hierarchy<B>& h, int i) {
    const LevelData<B>&fine = h[i - 1], &coarse = h[i];
    h.clock.time("restrict", i, [&] {
      update_vertices<B>(
          h.exec(), "plica::restrict", coarse.model.vertices,
          RestrictState<B>{coarse.adjoint, sources<B>(h.exec(), coarse.of_finer, fine.state),
                           coarse.state, coarse.model.inverse_mass});
      hold_sliding(h.exec(), coarse, coarse.state);
      coarse.start.copy(h.exec(), coarse.state);
    });
  }

  /// Returns the contact step of the level's own sub-steps, for forces that tau is made of.
  /// A macro step is too long for a stiff penalty force to stay constant.
  static ContactStep contact_of(const Level<B>& level, double t) {
    return {.span = level.share * t / level.substeps, .ends = false};
  }

  /// Leaves in level.f the level's corrected force at this state, for the next coarser level.
  void correct(Hierarchy<B>& h, int i, double time, double t) {
    const LevelData<B>& fine = h[i - 1];
    Level<B>& coarse = h[i];
    const Vectors<B>& tau = correction_[static_cast<std::size_t>(i)];
    coarse.set_correction({});
    coarse.evaluate(coarse.state, time, coarse.f, contact_of(coarse, t));
    h.clock.time("correct", i, [&] {
      update_vertices<B>(
          h.exec(), "plica::correction", coarse.model.vertices,
          DefectCorrection<B>{coarse.adjoint, sources<B>(h.exec(), coarse.of_finer, fine.f),
                              coarse.finer_inverse_mass, coarse.model.inverse_mass, coarse.f, tau});
    });
    coarse.set_correction(tau);
    coarse.add_correction(coarse.f);
  }

  static void interpolate_variation(Hierarchy<B>& h, int i) {
    const LevelData<B>&fine = h[i], &coarse = h[i + 1];
    h.clock.time("interpolate", i, [&] {
      map_fields<B, MapVariation>(h.exec(), "plica::interpolate", coarse.to_finer,
                                  sources<B>(h.exec(), coarse.for_finer, coarse.state),
                                  sources<B>(h.exec(), coarse.for_finer, coarse.start, 1),
                                  fine.state, fine.state, {});
    });
  }
};

}  // namespace plica
