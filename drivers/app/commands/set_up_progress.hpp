// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace plica::app {

/// Says on the standard error what a set-up is doing, once it takes more than two seconds: one line per phase, on a terminal or
/// not. The library names its phases as regions of Kokkos' profiling interface, "plica: ...", and this listens to them. One at a
/// time.
class SetUpProgress {
 public:
  explicit SetUpProgress(bool quiet);
  ~SetUpProgress();
  SetUpProgress(const SetUpProgress&) = delete;
  SetUpProgress& operator=(const SetUpProgress&) = delete;

  /// A phase of the application's own begins; the last one ends.
  void phase(const std::string& name);
  /// From here on listens to the library, until finish(). Needs Kokkos.
  void listen();
  /// The set-up is over; nothing is said any more. The time since the start [s].
  double finish();

 private:
  using Clock = std::chrono::steady_clock;
  static void begin_region(const char* name);
  static void end_region();
  void enter(const std::string& name);
  void say() const;
  void wait();

  bool quiet_, listening_ = false, late_ = false, over_ = false;
  int depth_ = 0;  // regions within a region are part of its phase
  std::string current_;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace plica::app
