// SPDX-License-Identifier: BSD-3-Clause
// What a simulation does where other work takes cores from it.
//
// The threads of a kernel end together. Where one of two has no core, every launch waits until it
// gets one, which takes milliseconds: a step of 50 launches takes many times as long as with the
// one thread that has a core. So a simulation that shares its cores looks at how long its threads
// waited for one, tries fewer threads where they did, and more again from time to time:
//
//     threads   waited > 1/20              waited less
//        2      o----.                      .--------o-------
//                    | try          try     |
//        1           '----o---------o-------'                    a try that is not faster goes back, and the next one comes later
//
// Results have the same bits with any number of threads.
#pragma once
#include <Kokkos_Timer.hpp>
#include <chrono>
#include <optional>
#include <plica/core/backend.hpp>
#include <vector>

namespace plica {

/// How much of this process's time other work takes from it: the time in which its threads were
/// ready to run and had no core.
class CoreWait {
 public:
  CoreWait();
  /// Part of the time of so many threads since the construction, from 0 to 1. None where the system
  /// does not tell it: Linux does, in /proc/self/task/*/schedstat.
  std::optional<double> share(int threads) const;

 private:
  std::chrono::steady_clock::time_point begin_;
  std::optional<double> waited_;  ///< by all threads until then [s]
};

/// Which number of threads steps are taken with: all, all but one, half, a quarter, ..., one.
class ThreadChoice {
 public:
  explicit ThreadChoice(int all);
  int threads() const { return rungs_[at_]; }
  bool tries() const { return came_from_.has_value(); }  ///< whether this number is on trial

  /// To be told after some steps: the time now, that of a step [s], and which part of it the
  /// threads waited for cores.
  void look(double now, double per_step, double waited);

 private:
  std::vector<int> rungs_;
  std::size_t at_ = 0;
  std::optional<std::size_t> came_from_;         ///< where a trial goes back to
  double before_ = 0;                            ///< time of a step there [s]
  double next_trial_ = 0, pause_ = first_pause;  ///< [s]
  static constexpr double first_pause = 0.5, longest_pause = 8;

  void try_out(std::size_t rung, double per_step);
};

/// The execution space of a simulation, with as many threads as are good for it. Only OpenMP's is
/// ever changed.
template <class B>
class SharedCores {
 public:
  using Exec = typename B::Exec;
  explicit SharedCores(const Exec& all);
  int threads() const { return choice_.threads(); }
  /// After a step that took so long [s]. Returns the space for the next one where that is another.
  std::optional<Exec> after_step(double seconds);

 private:
  Exec all_;
  ThreadChoice choice_;
  Kokkos::Timer clock_;
  CoreWait wait_;        ///< since the first of the steps that are looked at together
  int steps_ = 0;        ///< of them
  double seconds_ = 0;   ///< they took
  double per_step_ = 0;  ///< in those before them [s]
};

}  // namespace plica
