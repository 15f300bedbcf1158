// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <unistd.h>

#include <Kokkos_Core.hpp>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <plica/drivers/python/access.hpp>
#include <stdexcept>
#include <thread>

namespace nb = nanobind;

namespace plica::python {
namespace {

struct Queue {
  std::mutex mutex;
  std::condition_variable changed;
  std::thread::id owner;
  int depth = 0;    // number of the owner's nested objects; 0: nobody has it
  int waiting = 0;  // threads
  long taken = 0;   // times
};
// On the heap: a child process gets a new one, since a thread that it lacks may have locked this
Queue* queue = new Queue;
std::atomic<bool> ending = false;
bool lost = false;

// Linux: the main thread has the number of the process
bool is_main_thread() { return getpid() == gettid(); }

void take_now(Queue& q) { q.owner = std::this_thread::get_id(), q.depth = 1, ++q.taken; }

// Waits for the access, without the GIL
void take(bool heeds_signals) {
  Queue& q = *queue;
  Signals signals;
  std::unique_lock lock(q.mutex);
  ++q.waiting;
  const auto leave = [&] { --q.waiting, q.changed.notify_all(); };
  while (!q.changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return q.depth == 0; })) {
    if (!heeds_signals) continue;
    lock.unlock();
    try {
      signals();
    } catch (...) {
      lock.lock();
      leave();
      throw;
    }
    lock.lock();
  }
  take_now(q);
  leave();
}

}  // namespace

void Signals::operator()() {
  if (!is_main_thread() || Clock::now() - last_ < std::chrono::milliseconds(50)) return;
  const nb::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
  last_ = Clock::now();
}

Access::Access(bool heeds_signals) {
  if (lost)
    throw std::runtime_error(
        "this process was forked after Kokkos had started its threads, which it does not have; "
        "expected multiprocessing's start method 'spawn', or plica.init(threads=1) before the "
        "fork");
  {
    Queue& q = *queue;
    const std::lock_guard lock(q.mutex);
    const bool ours = q.depth > 0 && q.owner == std::this_thread::get_id();
    if (ours) ++q.depth;
    if (q.depth == 0) take_now(q);
    if (q.owner == std::this_thread::get_id()) return;
  }
  const nb::gil_scoped_release release;
  take(heeds_signals);
}

Access::~Access() {
  Queue& q = *queue;
  const std::lock_guard lock(q.mutex);
  if (--q.depth == 0) q.changed.notify_all();
}

void Access::offer() {
  Queue& q = *queue;
  {
    std::unique_lock lock(q.mutex);
    if (q.waiting == 0 || q.depth > 1) return;
    const long before = q.taken;
    q.depth = 0;
    q.changed.notify_all();
    q.changed.wait(lock, [&] { return q.taken != before || q.waiting == 0; });
  }
  take(false);
}

void Access::end() {
  ending = true;
  {
    Queue& q = *queue;
    const std::lock_guard lock(q.mutex);
    if (q.depth > 0 && q.owner == std::this_thread::get_id()) return;
  }
  const nb::gil_scoped_release release;
  take(false);
}

void Access::stop_at_end() {
  if (!ending || is_main_thread()) return;
  {
    Queue& q = *queue;
    const std::lock_guard lock(q.mutex);
    q.depth = 0;
    q.changed.notify_all();
  }
  while (true) pause();
}

void Access::after_fork() {
  Queue& old = *queue;
  const bool other = old.depth > 0 && old.owner != std::this_thread::get_id();
  const bool started = Kokkos::is_initialized() && !Kokkos::is_finalized();
  lost = lost || (started && (other || Kokkos::DefaultExecutionSpace().concurrency() > 1));
  queue = new Queue;
  if (!other) queue->owner = old.owner, queue->depth = old.depth;
}

bool Access::lost_by_fork() { return lost; }

}  // namespace plica::python
