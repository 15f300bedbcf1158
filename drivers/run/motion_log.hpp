// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <optional>
#include <plica/core/problem.hpp>
#include <plica/drivers/contact/contact.hpp>
#include <variant>
#include <vector>

namespace plica {

/// What callers have said of the motion of obstacles since the oldest state that a simulation can
/// go back to: in steps that are taken again obstacles move as they did the first time.
///
///   then_     how each one moved before all of these
///   said_     | time, obstacle, its motion or turn | ...      ascending in time; from next_ on, after a way back, not yet said again
template <class B>
class MotionLog {
 public:
  using Said = std::variant<Motion, std::optional<Turn>>;

  explicit MotionLog(const ContactOptions& contact) {
    for (const ObstacleOptions& o : contact.obstacles) then_.push_back({o.motion, o.turn});
  }

  /// From this time [s] on. What was said of later times is forgotten.
  void say(const Contact<B>& contact, double time, int obstacle, const Said& what) {
    said_.erase(said_.begin() + static_cast<std::ptrdiff_t>(next_), said_.end());
    said_.push_back({time, obstacle, what});
    go_on(contact, time);
  }

  /// Obstacles move as they did before this time.
  void go_back(const Contact<B>& contact, double time) {
    for (std::size_t o = 0; o < then_.size(); ++o) {
      contact.set_motion(static_cast<int>(o), then_[o].motion);
      contact.set_turn(static_cast<int>(o), then_[o].turn);
    }
    for (next_ = 0; next_ < said_.size() && said_[next_].time < time; ++next_)
      apply(contact, said_[next_]);
  }

  /// To a step that begins at this time.
  void go_on(const Contact<B>& contact, double time) {
    for (; next_ < said_.size() && said_[next_].time <= time; ++next_) apply(contact, said_[next_]);
  }

  /// Nobody goes back further than to this time.
  void forget_before(double time) {
    std::size_t count = 0;
    for (; count < next_ && said_[count].time < time; ++count) {
      Moves& moves = then_[static_cast<std::size_t>(said_[count].obstacle)];
      if (const Motion* motion = std::get_if<Motion>(&said_[count].what)) moves.motion = *motion;
      if (const auto* turn = std::get_if<std::optional<Turn>>(&said_[count].what))
        moves.turn = *turn;
    }
    said_.erase(said_.begin(), said_.begin() + static_cast<std::ptrdiff_t>(count));
    next_ -= count;
  }

  /// Nobody goes back at all. What was not yet said again is forgotten.
  void forget() {
    forget_before(std::numeric_limits<double>::infinity());
    said_.clear(), next_ = 0;
  }

 private:
  struct Moves {
    Motion motion;
    std::optional<Turn> turn;
  };
  struct Change {
    double time;
    int obstacle;
    Said what;
  };
  std::vector<Moves> then_;
  std::vector<Change> said_;
  std::size_t next_ = 0;

  static void apply(const Contact<B>& contact, const Change& change) {
    if (const Motion* motion = std::get_if<Motion>(&change.what))
      contact.set_motion(change.obstacle, *motion);
    if (const auto* turn = std::get_if<std::optional<Turn>>(&change.what))
      contact.set_turn(change.obstacle, *turn);
  }
};

}  // namespace plica
