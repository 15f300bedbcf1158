// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/text.hpp>
#include <plica/drivers/time/implicit_step.hpp>
#include <string>
#include <utility>
#include <vector>

namespace plica {

/// Load step to equilibrium, for the cycle `rest`.
///
/// A load step takes stages of backward Euler, each from a state without velocity:
///
///   minimise  E(u) + |u - u_k|^2_M / 2 l^2,   l the length of the stage [s]
///
/// until a stage begins with balanced forces (pseudo-transient continuation: Kelley & Keyes, SIAM
/// J. Numer. Anal. 35, 1998). E falls from stage to stage. l grows while stages are solved, up to
/// where the second term vanishes beside the stiffness: a stage is then Newton's method for
/// equilibrium. l is shorter where that method fails, or where the body goes far before it finds
/// what it touches. So a body may be held by contact alone, or soften. Masses have no part in the
/// result.
///
/// Loads, given motions and obstacles are at the end of the load step in all stages; obstacles get
/// there in the first. A load step that does not come to rest is not solved, see unsolved().
///
/// A stage knows where contact was when it began. Where a face gives way to a round tool, the place
/// of contact moves along it, and the next stage goes back: further than the last one went where
/// the tool presses much. So a stage may keep a part of its way, see damp().
template <class B>
class RestStep final : public ImplicitStep<B> {
  using Real = typename B::Real;

 public:
  RestStep(const LevelData<B>& level, const IntegratorParts<B>& parts)
      : ImplicitStep<B>(level, parts),
        tolerance_(parts.rest),
        edge_(parts.edge),
        given_(on_any_rank<B>(level, level.prescribed.count > 0)),
        critical_(parts.critical_step > 0 && std::isfinite(parts.critical_step)
                      ? parts.critical_step
                      : 1e-6) {
    if (!parts.contact) return;
    way_ = Vectors<B>("plica::rest.way", level.model.vertices);
    last_way_ = Vectors<B>("plica::rest.last_way", level.model.vertices);
  }

  void reset_history() override {
    length_ = 0;
    this->stages().forget_dilatations();
  }
  int failed_vertex() const override { return worst_; }
  std::string failure() const override {
    if (!(this->unsolved() > 0)) return {};
    return text("no equilibrium was found at ", number(end_, 4),
                " s: ", number(this->unsolved(), 3),
                " of the forces are not balanced, most at this vertex; expected at most ",
                number(tolerance_, 3));
  }
  void name_fields(Archive<B>& archive) override {
    ImplicitStep<B>::name_fields(archive);
    archive.number(length_);
    archive.owns(way_, last_way_);
  }

 protected:
  bool step(Level<B>& level, double time, double h) override {
    end_ = time + h, worst_ = -1, part_ = 0;
    if (level.contact()) level.response().find_precisely();
    if (length_ == 0) length_ = first_length * critical_;
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0, failures = 0; k < most_stages && failures < most_failures; ++k) {
      const bool solved = stage(level, time, h, k == 0);
      if (this->stages().began_at_rest()) return stop(level), true;
      const bool moved = k == 0 && given_;
      if (!solved && (moved || length_ < critical_)) break;
      const double left = this->stages().unsolved(),
                   way =
                       level.contact() && !moved
                           ? this->stages().sums().farthest(level, this->stages().base().u) / edge_
                           : 0;
      // without an equilibrium, what is not balanced does not become less
      const bool runs_away = k >= few_stages && way < near && !(left < progress * before);
      if (!solved || runs_away) ++failures;
      before = left;
      adapt(level, solved, way);
      if (k == 0) part_ = 0;  // the first stage's way is mostly that of obstacles
    }
    find_worst(level);
    stop(level);
    return false;
  }

 private:
  // lengths of stages, over the critical step: the first one, and the longest. In the last, even a
  // mode of a ten-thousandth of the highest frequency moves to its equilibrium but for 3e-7
  static constexpr double first_length = 1e3, longest = 1e7;
  static constexpr double grows = 100, shrinks = 0.1;
  // maximum ways of a vertex in a stage with contact, in edges: for a longer stage, and at all
  static constexpr double near = 0.5, far = 2;
  static constexpr int most_stages = 60, most_failures = 10, few_stages = 3;
  // part of the forces that were not balanced, of which a stage leaves less
  static constexpr double progress = 0.9;
  // least part of its way that a stage keeps
  static constexpr double least_part = 0.05;
  // part of the load step in which obstacles stand still, in all stages but the first
  static constexpr double instant = 1e-9;

  double tolerance_, edge_;
  bool given_;  ///< whether the motion of a vertex of the whole level is given
  double critical_;
  double length_ = 0;  ///< length of the next stage [s]; 0: that of a first one
  double end_ = 0;     ///< end of the last load step [s]
  int worst_ = -1;
  Vectors<B> way_, last_way_;  ///< ways of the vertices in a stage and in the last one [m]
  double part_ = 0;  ///< part of its way that the last stage kept; 0: no stage to compare with

  /// Sets all velocities to 0.
  static void stop(const Level<B>& level) { fill(level.exec(), level.state.v, Real(0)); }

  /// Takes a stage of length_ from the level's state; returns whether it was solved.
  bool stage(Level<B>& level, double time, double h, bool first) {
    StageSolver<B>& stages = this->stages();
    stop(level);
    if (first) prescribe(level.exec(), level, level.state, time, h);
    stages.base().copy(level.exec(), level.state);
    return stages.solve(level, first ? time : time + h, first ? h : 0, {length_ * length_, length_},
                        {.span = first ? h : instant * h});
  }

  /// Accepts a stage, or takes it back, and sets the length of the next one. `way`: the largest of
  /// a vertex in the stage, in edges, where the body may touch something.
  void adapt(Level<B>& level, bool solved, double way) {
    StageSolver<B>& stages = this->stages();
    if (way > far) {  // the body would pass through what it has not found
      copy(level.exec(), level.state.u, stages.base().u);
      length_ *= std::sqrt(near / way), part_ = 0;
      return stages.forget_dilatations();
    }
    if (level.contact()) {
      if (solved) damp(level);
      level.response().end_stage(level.exec(), level, level.state);
    }
    const double length = length_;
    if (!solved)
      length_ *= shrinks;
    else if (way < near)
      length_ = std::min(grows * length_, longest * critical_);
    if (!solved || length_ != length) part_ = 0;
    if (solved) stages.forget_dilatations();
  }

  /// Takes back a part of the stage's way where stages go to and fro, by Aitken's rule for vectors:
  /// between the starts of two stages, it goes to where their ways would be least if they changed
  /// linearly (B. Irons, R. Tuck, Int. J. Numer. Methods Engrg. 1, 1969). It never goes further
  /// than the stage.
  void damp(Level<B>& level) {
    const StageSums<B>& sums = this->stages().sums();
    const Vectors<B>& u = level.state.u;
    combine<B>(level.exec(), "plica::rest_way", 1, u, -1, this->stages().base().u, way_);
    double part = 1;
    if (part_ > 0) {
      const double last = sums.product(level, last_way_, last_way_),
                   both = sums.product(level, last_way_, way_),
                   best =
                       part_ * (last - both) / (last - 2 * both + sums.product(level, way_, way_));
      if ((both < 0 || part_ < 1) && best > 0) part = std::clamp(best, least_part, 1.0);
    }
    if (part < 1) add<B>(level.exec(), "plica::rest_part", static_cast<Real>(part - 1), way_, u);
    std::swap(way_, last_way_), part_ = part;
  }

  /// Finds the vertex with the largest force that is not balanced, by its number in the whole mesh.
  void find_worst(const Level<B>& level) {
    const auto force = host_values(level.exec(), level.f),
               inverse_mass = host_values(level.exec(), level.model.inverse_mass);
    const Items owned = vertices_of<B>(level);
    double most = 0;
    for (auto a = static_cast<std::size_t>(owned.first); a < static_cast<std::size_t>(owned.last);
         ++a) {
      double square = 0;
      for (std::size_t k = 0; k < 3; ++k)
        square += static_cast<double>(force[3 * a + k]) * static_cast<double>(force[3 * a + k]);
      if (inverse_mass[a] > 0 && square > most) most = square, worst_ = static_cast<int>(a);
    }
    if (!level.ranks) return;
    Ranks& ranks = *level.ranks->ranks;
    double largest = most;
    ranks.most({&largest, 1});
    if (!(largest > 0)) return;
    // the lowest number of those that have it
    double number = most == largest ? -level.ranks->part.vertex[static_cast<std::size_t>(worst_)]
                                    : -std::numeric_limits<double>::infinity();
    ranks.most({&number, 1});
    worst_ = static_cast<int>(-number);
  }
};

}  // namespace plica
