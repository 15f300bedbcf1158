// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>

namespace plica {

/// Division of a macro step that fails, into parts of 1/2^depth of it. A part that fails is taken
/// again in halves. After some parts that pass, parts become twice as long, up to the whole step.
/// So short parts last as long as the difficulty, also beyond the macro step's end.
///
///   depth 0   |              fails                |
///         1   |      fails      |
///         2   | passes | passes |
///         1                     |     passes      |      the next macro step starts in halves
class StepControl {
 public:
  explicit StepControl(int most_halvings) : most_(most_halvings) {}

  /// Returns whether a macro step can be halved at all.
  bool halves() const { return most_ > 0; }
  /// Returns whether the next part is shorter than the whole step.
  bool divides() const { return depth_ > 0; }

  // The next part, its start and size as parts of a macro step
  void begin() { at_ = 0; }
  bool done() const { return at_ >= whole(); }
  double start() const { return static_cast<double>(at_) / static_cast<double>(whole()); }
  double size() const { return 1.0 / static_cast<double>(1L << depth_); }

  /// Halves the next part, which has failed. Returns false where it can be no shorter.
  bool halve() {
    if (depth_ == most_) return false;
    if (grew_ && passed_ < wait_) wait_ = std::min(2 * wait_, longest_wait);
    ++depth_, ++halvings_, passed_ = 0, grew_ = false;
    return true;
  }
  /// Goes on to the next part, after one that has passed. May double its length.
  void pass() {
    at_ += whole() >> depth_;
    if (++passed_ < wait_ || depth_ == 0 || at_ % (whole() >> (depth_ - 1)) != 0) return;
    if (grew_) wait_ = shortest_wait;  // the last growth lasted
    --depth_, passed_ = 0, grew_ = true;
  }
  long halvings() const { return halvings_; }

  template <class Archive>
  void name_fields(Archive& archive) {
    for (long* value : {&depth_, &passed_, &wait_, &halvings_}) archive.number(*value);
    archive.number(grew_);
  }

 private:
  static constexpr long shortest_wait = 4, longest_wait = 256;  // parts that pass before they grow

  int most_;
  long at_ = 0;  ///< start of the next part, in units of the shortest part
  long depth_ = 0, passed_ = 0, wait_ = shortest_wait, halvings_ = 0;
  bool grew_ = false;  ///< parts have grown, and not been halved since

  long whole() const { return 1L << most_; }
};

}  // namespace plica
