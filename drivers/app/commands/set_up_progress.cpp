// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Kokkos_Core.hpp>
#include <plica/drivers/app/commands/set_up_progress.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <string_view>

namespace plica::app {
namespace {

constexpr std::chrono::seconds patience(2);
constexpr std::string_view ours = "plica: ";

SetUpProgress* listener = nullptr;                     // Kokkos calls plain functions
Kokkos::Tools::Experimental::EventSet tools_of_users;  // what the user's profiling tool has set

}  // namespace

SetUpProgress::SetUpProgress(bool quiet) : quiet_(quiet) {
  if (!quiet_) thread_ = std::thread([this] { wait(); });
}

SetUpProgress::~SetUpProgress() { finish(); }

double SetUpProgress::finish() {
  const std::chrono::duration<double> since = Clock::now() - start_;
  if (listening_) Kokkos::Tools::Experimental::set_callbacks(tools_of_users), listener = nullptr;
  listening_ = false;
  if (!thread_.joinable()) return since.count();
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
  return since.count();
}

void SetUpProgress::phase(const std::string& name) { enter(name); }

void SetUpProgress::listen() {
  if (quiet_) return;
  listener = this, listening_ = true;
  tools_of_users = Kokkos::Tools::Experimental::get_callbacks();
  Kokkos::Tools::Experimental::set_push_region_callback(begin_region);
  Kokkos::Tools::Experimental::set_pop_region_callback(end_region);
}

void SetUpProgress::begin_region(const char* name) {
  if (tools_of_users.push_region != nullptr) tools_of_users.push_region(name);
  const std::string_view text = name;
  if (listener->depth_++ == 0 && text.starts_with(ours)) listener->enter(std::string(text.substr(ours.size())));
}

void SetUpProgress::end_region() {
  --listener->depth_;
  if (tools_of_users.pop_region != nullptr) tools_of_users.pop_region();
}

void SetUpProgress::enter(const std::string& name) {
  const std::lock_guard lock(mutex_);
  current_ = name;
  if (late_) say();
}

void SetUpProgress::say() const {
  if (current_.empty()) return;
  const std::chrono::duration<double> since = Clock::now() - start_;
  message(fmt::format("set-up, {:.1f} s: {}", since.count(), current_));
}

void SetUpProgress::wait() {
  std::unique_lock lock(mutex_);
  if (changed_.wait_for(lock, patience, [this] { return over_; })) return;
  late_ = true;
  say();
}

}  // namespace plica::app
