// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <limits>
#include <plica/drivers/solver/diagnose.hpp>
#include <plica/drivers/solver/simulation_inside.hpp>

namespace plica {

/// The checks of a macro step, or of a part of it, and what is done about one that does not pass them. Inside: what a simulation
/// owns.
template <class B, class Inside>
class MacroStepCheck {
 public:
  explicit MacroStepCheck(Inside& inside) : s_(inside) {}

  /// The first that does not hold of the state as it is, the last step having covered this part of a macro step.
  std::optional<Diagnosis> examine(double part = 1) {
    if (s_.built.cycle->alarmed(s_.hierarchy()) && !s_.repair()) return failure("stability");
    if (s_.budget_opens) s_.open_budget();
    const MotionReport now = s_.meter.motion(s_.drift);
    const double motion = now.edges_per_second * substep() * part;
    const bool retries = s_.problem.integration.retry.halvings > 0;
    if (retries) look_at_end();
    if (auto inverted = find_inverted<B>(s_.built)) return inverted->motion_over_edge = motion, inverted;
    const Energies& e = now.energies;
    if (!std::isfinite(e.kinetic) || !std::isfinite(e.potential)) return failure("non_finite");
    for (std::size_t i = 0; i < s_.hierarchy().levels.size(); ++i)
      if (const std::string why = s_.hierarchy().levels[i].integrator->failure(); !why.empty())
        return failure("solver", motion, static_cast<int>(i), why);
    if (const Contact<B>* contact = s_.hierarchy()[0].forces->contact())
      if (const int point = contact->take_lost(s_.hierarchy().exec()); point >= 0)
        return failure("contact", motion, 0, "surface point " + std::to_string(point));
    s_.put_in = std::max(s_.put_in, s_.start - e.potential);
    // elastic and contact energy are not negative: kinetic energy beyond what was put in is made of nothing. Twice, since
    // discrete energies waver; never less than that of a thousandth of an edge per step
    const LevelReport& finest = s_.built.reports.front();
    const double edge_speed = 1e-3 * finest.mean_edge / s_.built.macro_step;
    const double allowed = 2 * s_.put_in + 0.5 * finest.mass * edge_speed * edge_speed;
    if (s_.budget_known && e.kinetic + (retries ? s_.meter.all(s_.time).elastic : 0) > allowed)
      return failure("energy", motion);
    // An explicit sub-step is about the time that sound takes across half an element. What leaves the body as a whole by more
    // than an edge in it is faster than sound: elements there are passed through within a step, whatever the forces say.
    // But for the law that is linear in any state, and stable at any amplitude.
    if (finest.explicit_integrator && !s_.linear && motion > 1) return failure("speed", motion);
    s_.drift = now.drift;
    return {};
  }

  /// Once more from the last kept state: a macro step that is bad is halved, each half likewise, so often at most. Every macro
  /// step starts whole and ends at its own time. What is left of `bad` where that does not help.
  std::optional<Diagnosis> retry(const Diagnosis& bad) {
    const long there = s_.steps;
    const bool known = there - s_.kept_steps == 1;  // to be bad as a whole
    s_.go_back();
    ++s_.rejected;
    std::optional<Diagnosis> still = bad;
    while (s_.steps < there) {
      const int left = s_.problem.integration.retry.halvings;
      still = known ? halves(s_.time, s_.built.macro_step, left) : cover(s_.time, s_.built.macro_step, left);
      if (still) return still;
      s_.time = static_cast<double>(++s_.steps) * s_.built.macro_step;
    }
    return {};
  }

 private:
  /// What a part of a macro step starts from.
  struct Before {
    explicit Before(Inside& s) : put_in(s.put_in), drift(s.drift) {
      for (const auto& part : s.hierarchy().levels) {
        State<B>& state = states.emplace_back("before", part.level.model.vertices);
        state.copy(s.hierarchy().exec(), part.level.state);
      }
    }
    std::vector<State<B>> states;
    double put_in;
    Point drift;
  };

  Inside& s_;

  /// Flags level 0's inverted elements as they are now. Without it the next step's first force would, which is early enough to
  /// stop, but too late to take this step again; likewise an element may have taken up energy that nothing has put in.
  void look_at_end() {
    const HierarchyLevel<B>& part = s_.hierarchy()[0];
    const Level<B>& level = part.level;
    if (level.flags.evaluation.extent(0) > 0)
      part.forces->elasticity().force(s_.hierarchy().exec(), level.model.patches, level.state, level.flags,
                                      std::numeric_limits<int>::max(), level.partial);
  }

  double substep() const {
    const LevelReport& finest = s_.built.reports.front();
    return finest.share * s_.built.macro_step / std::max(1, finest.substeps);
  }

  Diagnosis failure(const std::string& kind, double motion = 0, int level = -1, const std::string& reason = {}) const {
    Diagnosis d = locate_failure<B>(kind, s_.built, s_.kept, level, reason);
    d.motion_over_edge = motion;
    return d;
  }

  std::optional<Diagnosis> cover(double time, double span, int left) {
    const Before before(s_);
    s_.advance(time, span);
    const auto bad = examine(span / s_.built.macro_step);
    if (!bad) return {};
    ++s_.rejected;
    if (left == 0) return bad;
    s_.put_back(before.states);
    s_.put_in = before.put_in, s_.drift = before.drift;
    return halves(time, span, left);
  }

  std::optional<Diagnosis> halves(double time, double span, int left) {
    ++s_.halvings;
    if (const auto bad = cover(time, span / 2, left - 1)) return bad;
    return cover(time + span / 2, span / 2, left - 1);
  }
};

}  // namespace plica
