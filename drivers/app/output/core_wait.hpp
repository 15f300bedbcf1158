// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <optional>

namespace plica::app {

/// How much of this process's time other work takes from it: the time in which its threads were ready to run and had no core.
class CoreWait {
 public:
  CoreWait();
  /// Part of the time of so many threads since the construction, from 0 to 1. None where the system does not tell it: Linux does,
  /// in /proc/self/task/*/schedstat.
  std::optional<double> share(int threads) const;

 private:
  std::chrono::steady_clock::time_point begin_;
  std::optional<double> waited_;  ///< by all threads until then [s]
};

}  // namespace plica::app
