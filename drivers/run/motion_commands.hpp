// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/problem.hpp>
#include <plica/drivers/contact/contact.hpp>
#include <plica/drivers/run/archive_motion.hpp>
#include <variant>
#include <vector>

namespace plica {

/// Motions of obstacles as callers have set them, since the oldest state that a simulation can go
/// back to. In steps that are taken again, obstacles move as they did the first time.
///
///   initial_     how each obstacle moved before all of these
///   said_     | time, obstacle, its motion or turn | ...      ascending in time
///             after going back, those from next_ on are not yet applied again
template <class B>
class MotionCommands {
 public:
  using Command = std::variant<Motion, std::optional<Turn>>;

  explicit MotionCommands(const ContactOptions& contact) {
    for (const ObstacleOptions& o : contact.obstacles) initial_.push_back({o.motion, o.turn});
    given_ = initial_;
  }

  /// Returns whether obstacles may move otherwise than the problem says.
  bool commanded() const { return commanded_; }

  /// Names how obstacles move. A state in which they move as the problem says has no such part.
  void name_fields(Archive<B>& archive) {
    constexpr std::uint64_t mark = 0x6d6f76656d656e74;
    std::vector<Moves> moves = archive.saving() ? present() : given_;
    const bool others = archive.part(mark, commanded_);
    if (others)
      for (Moves& each : moves) name_motion(archive, each.motion), name_turn(archive, each.turn);
    if (!archive.restoring()) return;
    initial_ = std::move(moves), commanded_ = others;
    said_.clear(), next_ = 0;
  }

  /// Records how an obstacle moves from this time [s] on. Forgets what was set for later times.
  void record(const Contact<B>& contact, double time, int obstacle, const Command& what) {
    said_.erase(said_.begin() + static_cast<std::ptrdiff_t>(next_), said_.end());
    said_.push_back({time, obstacle, what});
    commanded_ = true;
    go_on(contact, time);
  }

  /// Makes obstacles move as they did before this time [s].
  void restore_snapshot(const Contact<B>& contact, double time) {
    for (std::size_t o = 0; o < initial_.size(); ++o) {
      contact.set_motion(static_cast<int>(o), initial_[o].motion);
      contact.set_turn(static_cast<int>(o), initial_[o].turn);
    }
    for (next_ = 0; next_ < said_.size() && said_[next_].time < time; ++next_)
      apply(contact, said_[next_]);
  }

  /// Applies what was set for a step that begins at this time [s].
  void go_on(const Contact<B>& contact, double time) {
    for (; next_ < said_.size() && said_[next_].time <= time; ++next_) apply(contact, said_[next_]);
  }

  /// Forgets what is only needed to go back further than to this time [s].
  void forget_before(double time) {
    std::size_t count = 0;
    for (; count < next_ && said_[count].time < time; ++count) note(initial_, said_[count]);
    said_.erase(said_.begin(), said_.begin() + static_cast<std::ptrdiff_t>(count));
    next_ -= count;
  }

  /// Forgets all that is only needed to go back, and what is not yet applied again.
  void reset_history() {
    initial_ = present();
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
    Command what;
  };
  std::vector<Moves> given_;  // motions that the problem says
  std::vector<Moves> initial_;
  std::vector<Change> said_;
  std::size_t next_ = 0;
  bool commanded_ = false;

  static void note(std::vector<Moves>& all, const Change& change) {
    Moves& moves = all[static_cast<std::size_t>(change.obstacle)];
    if (const Motion* motion = std::get_if<Motion>(&change.what)) moves.motion = *motion;
    if (const auto* turn = std::get_if<std::optional<Turn>>(&change.what)) moves.turn = *turn;
  }

  std::vector<Moves> present() const {
    std::vector<Moves> all = initial_;
    for (std::size_t i = 0; i < next_; ++i) note(all, said_[i]);
    return all;
  }

  static void apply(const Contact<B>& contact, const Change& change) {
    if (const Motion* motion = std::get_if<Motion>(&change.what))
      contact.set_motion(change.obstacle, *motion);
    if (const auto* turn = std::get_if<std::optional<Turn>>(&change.what))
      contact.set_turn(change.obstacle, *turn);
  }
};

}  // namespace plica
