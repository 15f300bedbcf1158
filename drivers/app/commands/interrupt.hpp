// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <plica/meshes/files/file_bytes.hpp>
#include <thread>
#include <vector>

namespace plica::app {

/// Returns true after Ctrl-C (SIGINT) or SIGTERM: the user wants the command to end. A command that
/// takes steps asks often; it then writes its last files and returns.
bool interrupted();

/// Handles Ctrl-C and SIGTERM in its scope: the first signal makes interrupted() true. A second
/// signal ends the program at once. A command may be too busy to ask: a set-up, or a macro step of
/// very many sub-steps. So a thread waits for the signal and gives the command half a second. Then
/// it calls the function that on_leave() has set, and ends the program with status 130.
///
///     signal ──> interrupted() is true ── 0.5 s ──> leave(), exit 130
///                         └── the command asks: end_in_order(), writes its last files, returns
///
/// At most one object of this class may exist at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  using Lock = std::unique_lock<std::mutex>;
  /// Returns a lock; while it exists, the thread does not end the program. Hold it to write files,
  /// or to change data that `leave` reads.
  Lock hold() { return Lock(mutex_); }
  /// Calls end_in_order() at the end of its scope, before the data that `leave` reads is destroyed.
  class Leaving {
   public:
    explicit Leaving(InterruptWatch& watch) : watch_(watch) {}
    ~Leaving() { watch_.end_in_order(); }
    Leaving(const Leaving&) = delete;
    Leaving& operator=(const Leaving&) = delete;

   private:
    InterruptWatch& watch_;
  };
  /// Sets the function that the thread calls before it ends the program. Without it, the thread
  /// says that nothing was written. The caller holds the lock; the thread holds it while it calls
  /// `leave`.
  [[nodiscard]] Leaving on_leave(const Lock& held, std::function<void()> leave);
  /// Tells the thread that the command ends by itself: the thread does not end the program.
  void end_in_order();
  /// Returns interrupted(), and calls end_in_order() if it is true. For a command that then writes
  /// its last files and returns at once.
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

/// Writes the files of measurements that Ctrl-C has stopped, and prints that they are in the
/// folder. No files: prints that nothing new was written.
void leave_files(const std::vector<FileBytes>& files, const std::filesystem::path& folder);

}  // namespace plica::app
