// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica {

/// Decides when longer steps are tried again after steps were cut.
/// The first try is 100 macro steps after a cut. After each try that failed or did not last the
/// wait is twice as long. So a body that stays stiff is tried ever more rarely, and a body that is
/// struck again and again keeps its short steps.
class RegrowSchedule {
 public:
  /// Records that steps were cut.
  void cut() {
    if (lasting_) wait_ *= 2;
    lasting_ = false, since_ = unknown;
  }
  /// Returns true where longer steps are to be tried, after `steps` macro steps of the run.
  bool due(long steps) {
    if (since_ == unknown) since_ = steps;
    return steps - since_ >= wait_;
  }
  /// Records a try after `steps` macro steps of the run. `longer`: steps became longer.
  void tried(long steps, bool longer) {
    since_ = steps, lasting_ = longer;
    longer ? ++count_ : wait_ *= 2;
  }
  /// Returns how often steps became longer.
  long count() const { return count_; }

  template <class Archive>
  void name_fields(Archive& archive) {
    archive.number(since_), archive.number(wait_), archive.number(count_), archive.number(lasting_);
  }

 private:
  static constexpr long unknown = -1;
  long since_ = unknown, wait_ = 100, count_ = 0;
  bool lasting_ = false;  // true: steps became longer, and were not cut since
};

}  // namespace plica
