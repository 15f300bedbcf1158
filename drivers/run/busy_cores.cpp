// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <plica/drivers/run/busy_cores.hpp>

namespace plica {

namespace {

constexpr double notable = 0.05;         // part of the threads' time; any machine has shorter waits
constexpr double faster = 0.95;          // part of a step's time; a smaller gain is noise
constexpr double enough = 0.1;           // time of a batch of steps [s]
constexpr double enough_to_try = 0.05;   // time of a batch in a trial [s]
constexpr double enough_to_fail = 0.01;  // time of a batch in a hopeless trial [s]
constexpr double hopeless = 2;           // a trial's time per step over that before it

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

// --- ThreadChoice --------------------------------------------------------------------------------

ThreadChoice::ThreadChoice(int all) : rungs_{std::max(all, 1)} {
  if (all > 2) rungs_.push_back(all - 1);
  for (int n = all / 2; n > 0; n /= 2)
    if (n < rungs_.back()) rungs_.push_back(n);
}

void ThreadChoice::try_out(std::size_t rung, double per_step) {
  came_from_ = at_, before_ = per_step, at_ = rung;
}

void ThreadChoice::look(double now, double per_step, double waited) {
  if (came_from_) {
    const bool stays = per_step < faster * before_;
    if (!stays) at_ = *came_from_, seeks_ = false;
    pause_ = stays ? first_pause : std::min(2 * pause_, longest_pause);
    next_trial_ = now + (stays && (seeks_ || waited > notable) ? 0 : pause_);
    came_from_.reset();
  } else if (now >= next_trial_) {
    const std::size_t fewer = seeks_ && at_ == 0 && rungs_.size() > 2 ? 2 : at_ + 1;
    if ((seeks_ || waited > notable) && fewer < rungs_.size())
      try_out(fewer, per_step);
    else if (at_ > 0)
      try_out(at_ - 1, per_step);
  }
}

// --- SharedCores ---------------------------------------------------------------------------------

template <class B>
SharedCores<B>::SharedCores(const Exec& all) : all_(all), choice_(all.concurrency()) {}

template <class B>
auto SharedCores<B>::after_step(double seconds) -> std::optional<Exec> {
  ++steps_, seconds_ += seconds;
  const bool fails = choice_.tries() && seconds_ > hopeless * steps_ * per_step_;
  const bool is_short = choice_.tries() || choice_.begins();
  if (seconds_ < (fails ? enough_to_fail : is_short ? enough_to_try : enough)) return {};
  const int before = choice_.threads();
  per_step_ = seconds_ / steps_;
  choice_.look(clock_.seconds(), per_step_, wait_.share(before).value_or(0));
  steps_ = 0, seconds_ = 0, wait_ = {};
  if (choice_.threads() == before) return {};
#if defined(KOKKOS_ENABLE_OPENMP)
  if constexpr (std::is_same_v<Exec, Kokkos::OpenMP>)
    return choice_.threads() == all_.concurrency() ? all_ : Exec(choice_.threads());
#endif
  return {};
}

#define PLICA_INSTANCE(REAL, EXEC) template class SharedCores<Backend<REAL, EXEC>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANCE)

}  // namespace plica
