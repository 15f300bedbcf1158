// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Timer.hpp>
#include <map>
#include <plica/core/backend.hpp>
#include <string>

namespace plica {

/// Wall time per stage and level, on request. It waits for the device at a stage's ends only when
/// it is on.
template <class B>
class StageTimer {
 public:
  explicit StageTimer(const typename B::Exec& exec) : exec_(exec) {}
  bool on = false;
  const typename B::Exec& exec() const { return exec_; }
  void set_exec(const typename B::Exec& exec) { exec_ = exec; }
  const std::map<std::string, double>& seconds() const { return seconds_; }

  /// Runs work() and books its time under "stage level".
  template <class Work>
  void time(const char* stage, int level, const Work& work) {
    if (!on) return work();
    exec_.fence();
    const Kokkos::Timer timer;
    work();
    exec_.fence();
    seconds_[stage + (" " + std::to_string(level))] += timer.seconds();
  }

 private:
  typename B::Exec exec_;
  std::map<std::string, double> seconds_;
};

}  // namespace plica
