// SPDX-License-Identifier: BSD-3-Clause
// Choice of the number of threads of a simulation, where other work takes cores from it.
//
// The threads of a kernel end together. Where one of two has no core, every launch waits until it
// gets one, which takes milliseconds. A step of 50 launches then takes many times as long as with
// the one thread that has a core. So a simulation that shares its cores measures how long its
// threads waited for one. Where they waited, it tries fewer threads, and more again from time to
// time:
//
//     threads   waited > 1/20              waited less
//        2      o----.                      .--------o-------
//                    | try          try     |
//        1           '----o---------o-------'
//
// A try that is not faster goes back, and the next one comes later.
//
// Threads that wake slowly make a small body's steps longer than one thread takes. So a run begins
// with tries of half as many threads, as long as these are faster.
//
// Results have the same bits with any number of threads.
#pragma once
#include <Kokkos_Timer.hpp>
#include <chrono>
#include <optional>
#include <plica/core/backend.hpp>
#include <vector>

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

/// Number of threads that steps are taken with: all, all but one, half, a quarter, ..., one.
class ThreadChoice {
 public:
  explicit ThreadChoice(int all);
  int threads() const { return rungs_[at_]; }
  bool tries() const { return came_from_.has_value(); }  ///< whether this number is on trial
  bool begins() const { return seeks_; }  ///< whether the tries at a run's beginning go on

  /// Judges some steps, and may choose another number of threads. Takes the present time [s], the
  /// time per step [s], and the part of it for which threads waited for cores.
  void look(double now, double per_step, double waited);

 private:
  std::vector<int> rungs_;
  std::size_t at_ = 0;
  bool seeks_ = true;  ///< whether fewer threads are tried although none has waited for a core
  std::optional<std::size_t> came_from_;         ///< rung that a failed trial goes back to
  double before_ = 0;                            ///< time per step on that rung [s]
  double next_trial_ = 0, pause_ = first_pause;  ///< time of the next trial; pause before it [s]
  static constexpr double first_pause = 0.5, longest_pause = 8;

  void try_out(std::size_t rung, double per_step);
};

/// Execution space of a simulation, with the number of threads that is fastest. Only that of OpenMP
/// is ever changed.
template <class B>
class SharedCores {
 public:
  using Exec = typename B::Exec;
  explicit SharedCores(const Exec& all);
  int threads() const { return choice_.threads(); }
  /// Judges a step that took so long [s]. Returns the space for the next step where it is another
  /// one.
  std::optional<Exec> after_step(double seconds);

 private:
  Exec all_;
  ThreadChoice choice_;
  Kokkos::Timer clock_;
  CoreWait wait_;        ///< waiting since the start of a batch: steps that are judged together
  int steps_ = 0;        ///< number of steps in the batch so far
  double seconds_ = 0;   ///< time of these steps [s]
  double per_step_ = 0;  ///< time per step in the batch before [s]
};

}  // namespace plica
