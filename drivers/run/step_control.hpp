// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>

namespace plica {

/// How a macro step is divided where it fails. It goes in parts of 1/2^depth of it. A part that
/// fails is taken again in halves; after some that pass, parts become twice as long, up to the
/// whole. So short steps last as long as what is hard, also beyond the macro step's end.
///
///   depth 0   |              fails                |
///         1   |      fails      |
///         2   | passes | passes |
///         1                     |     passes      |      the next macro step starts in halves
class StepControl {
 public:
  explicit StepControl(int most_halvings) : most_(most_halvings) {}

  /// Whether a macro step can be halved at all.
  bool halves() const { return most_ > 0; }
  /// Whether the next part is not the whole.
  bool divides() const { return depth_ > 0; }

  // The part that is next, of a macro step
  void begin() { at_ = 0; }
  bool done() const { return at_ >= whole(); }
  double start() const { return static_cast<double>(at_) / static_cast<double>(whole()); }
  double size() const { return 1.0 / static_cast<double>(1L << depth_); }

  /// It failed; false where it can be no shorter.
  bool halve() {
    if (depth_ == most_) return false;
    if (grew_ && passed_ < wait_) wait_ = std::min(2 * wait_, longest_wait);
    ++depth_, ++halvings_, passed_ = 0, grew_ = false;
    return true;
  }
  void pass() {
    at_ += whole() >> depth_;
    if (++passed_ < wait_ || depth_ == 0 || at_ % (whole() >> (depth_ - 1)) != 0) return;
    if (grew_) wait_ = shortest_wait;  // the last growth lasted
    --depth_, passed_ = 0, grew_ = true;
  }
  long halvings() const { return halvings_; }

  template <class Archive>
  void persist(Archive& archive) {
    for (long* value : {&depth_, &passed_, &wait_, &halvings_}) archive.number(*value);
    archive.number(grew_);
  }

 private:
  static constexpr long shortest_wait = 4, longest_wait = 256;  // parts that pass before they grow

  int most_;
  long at_ = 0;  ///< where the next part starts, in the shortest parts
  long depth_ = 0, passed_ = 0, wait_ = shortest_wait, halvings_ = 0;
  bool grew_ = false;  ///< parts have grown, and not been halved since

  long whole() const { return 1L << most_; }
};

}  // namespace plica
