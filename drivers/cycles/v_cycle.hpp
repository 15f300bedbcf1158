// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/cycles/shared_step.hpp>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/transfer/transfer.hpp>
#include <utility>

namespace plica {

/// V-cycle of Wu, Yao, Enquobahrie, Zhang & Audette (EMBC 2012).
/// On the way down, the state of every level goes to the next coarser one. On the way up, every
/// level takes over from the next coarser one and integrates its share of the macro step. Levels
/// act one after the other: the coarsest covers the macro step's beginning, the finest its end.
///
/// A mapping passes on the state itself or its variation, the change over one macro step. A
/// variation is added to a base without that change. On the way down the base is the level's state
/// at the start of the last cycle, on the way up it is the level's present state.
template <class B, class Down, class Up>
class VCycle final : public SharedStep<B> {
  using Base = SharedStep<B>;
  static constexpr bool keeps_previous = Down::needs_variation;
  static constexpr bool keeps_start = Down::needs_variation || Up::needs_variation;

 public:
  void begin(Hierarchy<B>& h) override {
    for (int i = 0; i < h.count() && h.count() > 1; ++i) {
      LevelData<B>& level = h[i];
      if (i > 0)
        map_fields<B, MapState>(h.exec(), "plica::restrict", level.from_finer,
                                sources<B>(h.exec(), level.of_finer, h[i - 1].state), {}, {},
                                level.state, {});
      hold_sliding(h.exec(), level, level.state);
      if (keeps_start) level.start.copy(h.exec(), level.state);
      if (keeps_previous && i + 1 < h.count()) level.previous.copy(h.exec(), level.state);
    }
  }

  void step(Hierarchy<B>& h, double time, double t) override {
    const int coarsest = h.count() - 1;
    if (coarsest > 0) Base::prescribe_levels(h, time);
    if (coarsest > 0) remember_start(h, 0);
    for (int i = 1; i <= coarsest; ++i) {
      restrict_state(h, i);
      remember_start(h, i);
    }
    for (int i = coarsest; i >= 0; --i) {
      if (i < coarsest) interpolate_state(h, i);
      time = Base::integrate(h, i, time, t);
    }
  }

 private:
  void allocate(Hierarchy<B>& h) override {
    for (int i = 0; i < h.count() && h.count() > 1; ++i) {
      if (keeps_start) h[i].start = State<B>("start", h[i].model.vertices);
      if (keeps_previous && i + 1 < h.count())
        h[i].previous = State<B>("previous", h[i].model.vertices);
    }
  }

  static void remember_start(Hierarchy<B>& h, int i) {
    LevelData<B>& level = h[i];
    if (keeps_previous && i + 1 < h.count()) std::swap(level.start, level.previous);
    if (keeps_start) h.clock.time("keep", i, [&] { level.start.copy(h.exec(), level.state); });
  }

  // Must be called before the coarse level's start is stored anew. coarse.start is then the state
  // at the start of the last cycle.
  static void restrict_state(Hierarchy<B>& h, int i) {
    const LevelData<B>&fine = h[i - 1], &coarse = h[i];
    h.clock.time("restrict", i, [&] {
      map_fields<B, Down>(h.exec(), "plica::restrict", coarse.from_finer,
                          sources<B>(h.exec(), coarse.of_finer, fine.state),
                          base<Down>(h, coarse.of_finer, fine.previous), coarse.start, coarse.state,
                          coarse.drift_limit);
      hold_sliding(h.exec(), coarse, coarse.state);
    });
  }

  static void interpolate_state(Hierarchy<B>& h, int i) {
    const LevelData<B>&fine = h[i], &coarse = h[i + 1];
    h.clock.time("interpolate", i, [&] {
      map_fields<B, Up>(h.exec(), "plica::interpolate", coarse.to_finer,
                        sources<B>(h.exec(), coarse.for_finer, coarse.state),
                        base<Up>(h, coarse.for_finer, coarse.start), fine.state, fine.state,
                        fine.drift_limit);
    });
  }

  /// Returns the state from which a mapping takes variations, where it takes them.
  template <class Rule>
  static State<B> base(const Hierarchy<B>& h,
                       const std::shared_ptr<const GatheredVertices<B>>& gathered,
                       const State<B>& state) {
    if constexpr (Rule::needs_variation) return sources<B>(h.exec(), gathered, state, 1);
    return {};
  }
};

}  // namespace plica
