// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <plica/drivers/run/core_wait.hpp>

namespace plica {

namespace {

/// Returns the time that all threads have waited for a core [s]. The second number of a thread's
/// line is that time in nanoseconds.
std::optional<double> waited_by_all_threads() {
  std::error_code none;
  double sum = 0;
  bool any = false;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", none)) {
    std::ifstream line(task.path() / "schedstat");
    double ran = 0, waited = 0;
    if (line >> ran >> waited) sum += 1e-9 * waited, any = true;
  }
  return any ? std::optional(sum) : std::nullopt;
}

}  // namespace

CoreWait::CoreWait() : begin_(std::chrono::steady_clock::now()), waited_(waited_by_all_threads()) {}

std::optional<double> CoreWait::share(int threads) const {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin_;
  const std::optional<double> now = waited_by_all_threads();
  if (!waited_ || !now || !(wall.count() > 0) || threads < 1) return {};
  return std::clamp((*now - *waited_) / (threads * wall.count()), 0.0, 1.0);
}

}  // namespace plica
