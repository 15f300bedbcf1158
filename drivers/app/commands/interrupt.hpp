// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <plica/meshes/files/memory_file.hpp>
#include <thread>
#include <vector>

namespace plica::app {

/// Whether the user wants the command to end: Ctrl-C (SIGINT) or SIGTERM came. A command that steps
/// asks often and ends in good order.
bool interrupted();

/// From here to the end of the scope the first Ctrl-C or SIGTERM makes interrupted() true. A second
/// one ends the program at once. A command may be too busy to ask: a set-up, or a macro step of
/// very many sub-steps. So a thread waits for the signal, gives the command half a second, then
/// calls what on_leave() has set and ends the program with status 130.
///
///     signal ──> interrupted() is true ── 0.5 s ──> leave(), exit 130
///                         └── the command asks: end_in_order(), writes its last files, returns
///
/// One at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  using Lock = std::unique_lock<std::mutex>;
  /// While this lives the thread does not end the program: whoever writes files or changes what
  /// `leave` reads holds it.
  Lock hold() { return Lock(mutex_); }
  /// Calls end_in_order() at the end of its scope, before what `leave` refers to goes.
  class Leaving {
   public:
    explicit Leaving(InterruptWatch& watch) : watch_(watch) {}
    ~Leaving() { watch_.end_in_order(); }
    Leaving(const Leaving&) = delete;
    Leaving& operator=(const Leaving&) = delete;

   private:
    InterruptWatch& watch_;
  };
  /// What the thread does before it ends the program, instead of saying that nothing was written.
  /// The caller holds the lock, and the thread holds it while it calls `leave`.
  [[nodiscard]] Leaving on_leave(const Lock& held, std::function<void()> leave);
  /// The command ends by itself from here on: the thread no longer ends the program.
  void end_in_order();
  /// interrupted(), for a command that then ends at once, in order.
  bool noticed() {
    if (interrupted()) end_in_order();
    return interrupted();
  }

 private:
  void wait();

  std::mutex mutex_;
  std::condition_variable ended_;
  bool in_order_ = false;
  std::function<void()> leave_;
  std::thread thread_;
};

/// What Ctrl-C leaves of measurements while one of them does not end: these files, and the word
/// that they are there. None: nothing is measured yet.
void leave_files(const std::vector<MemoryFile>& files, const std::filesystem::path& folder);

}  // namespace plica::app
