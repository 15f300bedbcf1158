// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica {

/// When steps that were cut are tried longer again: 100 macro steps after a cut, and twice as many
/// after each try that failed or did not last. So a body that stays stiff is tried ever more
/// rarely, and one that is struck again and again stays with short steps.
class Regaining {
 public:
  /// Steps were cut.
  void cut() {
    if (lasting_) wait_ *= 2;
    lasting_ = false, since_ = unknown;
  }
  /// Whether to try, after this many macro steps of the run.
  bool due(long steps) {
    if (since_ == unknown) since_ = steps;
    return steps - since_ >= wait_;
  }
  /// It was tried.
  void tried(long steps, bool longer) {
    since_ = steps, lasting_ = longer;
    longer ? ++count_ : wait_ *= 2;
  }
  /// How often steps became longer.
  long count() const { return count_; }

  template <class Archive>
  void persist(Archive& archive) {
    archive.number(since_), archive.number(wait_), archive.number(count_), archive.number(lasting_);
  }

 private:
  static constexpr long unknown = -1;
  long since_ = unknown, wait_ = 100, count_ = 0;
  bool lasting_ = false;  // made longer, and not cut since
};

}  // namespace plica
