// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <functional>
#include <string>

namespace plica::app {

/// A line on the terminal that tells how far a run is; nothing where there is no terminal, or where told to be quiet.
class Progress {
 public:
  /// The run goes on from `first_time` and `first_step`.
  Progress(double duration, bool quiet, double first_time = 0, long first_step = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// After a macro step; draws ten times a second at most. `halvings` of macro steps are told of where there are any.
  void update(double time, long steps, const std::function<long()>& halvings = {});

 private:
  using Clock = std::chrono::steady_clock;
  bool on_;
  double duration_, first_time_;
  long first_step_;
  Clock::time_point start_ = Clock::now(), drawn_{};
};

/// The line; `steps` took `wall_time` and led from `first_time` to here: "0.62 / 3.00 s [###.......]  21 %    812 steps/s   1.58 x real time    1.5 s left".
std::string progress_line(double time, double duration, long steps, double wall_time, int width, double first_time = 0);

}  // namespace plica::app
