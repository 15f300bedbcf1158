// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <optional>

namespace plica {

/// Time that other work takes from this process: its threads were ready to run and had no core.
class CoreWait {
 public:
  CoreWait();
  /// Returns the part of their time that so many threads have waited since construction, from 0
  /// to 1. None where the system does not tell it: Linux does, in /proc/self/task/*/schedstat.
  std::optional<double> share(int threads) const;

 private:
  std::chrono::steady_clock::time_point begin_;
  std::optional<double> waited_;  ///< time that all threads had waited until begin_ [s]
};

}  // namespace plica
