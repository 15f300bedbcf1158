// SPDX-License-Identifier: BSD-3-Clause
#include "support/device_memory.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <Kokkos_Core.hpp>
#include <Kokkos_Profiling_ProfileSection.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <new>

// Kokkos takes the memory of views on hosts from the operator new below. While a DeviceMemory is
// there, that comes from one stretch of pages of their own, which the processor can be told to
// guard.
namespace plica::test {
namespace {

// of addresses; only what is written to takes memory
constexpr std::size_t most_bytes = std::size_t{1} << 32;
struct GuardedLabel {
  std::string name;
  const char* data;
};
char* guarded = nullptr;
std::atomic<std::size_t> guarded_bytes{0};
std::atomic<bool> guarded_takes{false};
std::array<std::atomic<const char*>, 64> guarded_faults;
std::atomic<std::size_t> guarded_fault_count{0};
std::vector<GuardedLabel>* guarded_labels = nullptr;
Kokkos::Tools::Experimental::EventSet callbacks_before;
struct sigaction action_before;

bool in_guarded(const void* p) {
  const char* at = static_cast<const char*>(p);
  return guarded != nullptr && at >= guarded && at < guarded + most_bytes;
}

void* take_guarded(std::size_t size) {
  const std::size_t page = static_cast<std::size_t>(getpagesize()),
                    whole = (size + page - 1) / page * page;
  const std::size_t at = guarded_bytes.fetch_add(whole);
  return at + whole <= most_bytes ? guarded + at : nullptr;
}

void guard(bool on) { mprotect(guarded, guarded_bytes, on ? PROT_NONE : PROT_READ | PROT_WRITE); }

// Only what is allowed in handlers of signals
void on_fault(int signal, siginfo_t* info, void*) {
  const char* at = static_cast<const char*>(info->si_addr);
  if (!in_guarded(at)) {
    std::signal(signal, SIG_DFL);  // the next try ends the program, as it would have
    return;
  }
  const std::size_t number = guarded_fault_count.fetch_add(1);
  if (number < guarded_faults.size()) guarded_faults[number] = at;
  guard(false);
}

void on_kernel_begin(const char*, std::uint32_t, std::uint64_t*) { guard(false); }
void on_kernel_end(std::uint64_t) { guard(true); }
void on_copy_begin(Kokkos_Profiling_SpaceHandle, const char*, const void*,
                   Kokkos_Profiling_SpaceHandle, const char*, const void*, std::uint64_t) {
  guard(false);
}
void on_copy_end() { guard(true); }
void on_view(Kokkos_Profiling_SpaceHandle, const char* name, const void* data, std::uint64_t) {
  if (in_guarded(data)) guarded_labels->push_back({name, static_cast<const char*>(data)});
}

}  // namespace

DeviceMemory::DeviceMemory() {
  namespace Tools = Kokkos::Tools::Experimental;
  if (guarded == nullptr) {  // it stays, since Kokkos may have taken some of it for itself
    void* pages = mmap(nullptr, most_bytes, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (pages == MAP_FAILED) throw std::bad_alloc();
    guarded = static_cast<char*>(pages);
  }
  guarded_labels = new std::vector<GuardedLabel>;
  callbacks_before = Tools::get_callbacks();
  Tools::set_allocate_data_callback(on_view);
  guarded_takes = true;
}

DeviceMemory::~DeviceMemory() {
  guarded_takes = false;
  Kokkos::Tools::Experimental::set_callbacks(callbacks_before);
  delete guarded_labels;
}

void DeviceMemory::close() {
  namespace Tools = Kokkos::Tools::Experimental;
  guarded_fault_count = 0;
  struct sigaction action {};
  action.sa_sigaction = on_fault, action.sa_flags = SA_SIGINFO;
  sigaction(SIGSEGV, &action, &action_before);
  Tools::set_begin_parallel_for_callback(on_kernel_begin),
      Tools::set_end_parallel_for_callback(on_kernel_end);
  Tools::set_begin_parallel_reduce_callback(on_kernel_begin),
      Tools::set_end_parallel_reduce_callback(on_kernel_end);
  Tools::set_begin_parallel_scan_callback(on_kernel_begin),
      Tools::set_end_parallel_scan_callback(on_kernel_end);
  Tools::set_begin_deep_copy_callback(on_copy_begin),
      Tools::set_end_deep_copy_callback(on_copy_end);
  guard(true);
}

std::vector<std::string> DeviceMemory::open() {
  Kokkos::Tools::Experimental::set_callbacks(callbacks_before);
  Kokkos::Tools::Experimental::set_allocate_data_callback(on_view);
  guard(false);
  sigaction(SIGSEGV, &action_before, nullptr);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(guarded_fault_count.load(), guarded_faults.size()); ++i) {
    const char* at = guarded_faults[i];
    const auto found = std::ranges::upper_bound(*guarded_labels, at, {},
                                                &GuardedLabel::data);  // they lie in this order
    names.push_back(found == guarded_labels->begin() ? "what no view has" : std::prev(found)->name);
  }
  return names;
}

}  // namespace plica::test

// Kokkos asks for memory of views by this one; the library's own gives what std::free takes
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  if (plica::test::guarded_takes) return plica::test::take_guarded(size);
  const std::size_t step = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(step, (size + step - 1) / step * step);
}
void operator delete(void* p, std::align_val_t) noexcept {
  if (!plica::test::in_guarded(p)) std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t alignment) noexcept {
  operator delete(p, alignment);
}
void operator delete(void* p, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  operator delete(p, alignment);
}
