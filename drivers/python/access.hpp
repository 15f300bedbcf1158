// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>

/// One thread at a time: Python has several, and Kokkos, simulations and the arrays that follow
/// them are for one.
namespace plica::python {

/// Checks for Ctrl-C at most twenty times a second, while the caller does not hold the GIL. Throws
/// the Python exception. Only Python's main thread gets signals; in others it does nothing.
class Signals {
 public:
  void operator()();

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

/// The right of a thread to use simulations and Kokkos, while the object exists. Another thread
/// waits; within a thread, objects may nest.
///
/// A thread gives it back with the GIL held. So when the interpreter ends, no thread is left that
/// would come back into Python.
class Access {
 public:
  /// Waits for it, without the GIL, which the caller holds. Ctrl-C ends the wait, unless the caller
  /// says that it does not. Throws std::runtime_error in a child process that was forked after
  /// Kokkos had started threads.
  explicit Access(bool heeds_signals = true);
  ~Access();
  Access(const Access&) = delete;
  Access& operator=(const Access&) = delete;

  /// Lets another thread go first that waits, and waits until it is done. For the middle of long
  /// work; the caller has the access and does not hold the GIL.
  static void offer();

  /// Takes the access for good: the interpreter ends. Threads that compute stop before their next
  /// kernel and sleep until the process is gone. The caller holds the GIL.
  static void end();
  /// Puts a thread to sleep for good where end() was called. For places between two kernels; the
  /// caller has the access and does not hold the GIL.
  static void stop_at_end();

  /// To be called in a child process right after fork().
  static void after_fork();
  /// Returns whether this process was forked after Kokkos had started threads, which it lacks.
  static bool lost_by_fork();
};

}  // namespace plica::python
