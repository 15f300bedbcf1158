// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <link.h>

#include <Kokkos_Core.hpp>
#include <cstdint>
#include <cstdlib>
#include <plica/core/error.hpp>
#include <plica/drivers/python/kokkos_session.hpp>
#include <set>
#include <string_view>
#include <utility>

namespace plica::python {
namespace {

using Exec = Kokkos::DefaultExecutionSpace;
bool ours = false;

// Returns the library files in this process that contain Kokkos
std::set<std::string> copies() {
  std::set<std::string> found;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* names) {
        const std::string file = info->dlpi_name;
        if (file.find("libkokkoscore") != std::string::npos)
          static_cast<std::set<std::string>*>(names)->insert(file);
        return 0;
      },
      &found);
  return found;
}

}  // namespace

void start_kokkos(int threads) {
  if (Kokkos::is_finalized())
    throw InputError("Kokkos has come to its end in this process and cannot start again");
  if (Kokkos::is_initialized()) {
    if (threads > 0 && threads != Exec().concurrency())
      throw InputError(fmt::format(
          "threads: {} asked for, but Kokkos already runs with {}; call plica.init(threads={}) "
          "before anything else",
          threads, Exec().concurrency(), threads));
    return;
  }
  if (const auto files = copies(); files.size() > 1)
    throw InputError(
        fmt::format("two copies of Kokkos are in this process: {}", fmt::join(files, " and ")));
  // Prevents Kokkos' warning that OpenMP's threads are not bound. Binding is the user's choice, and
  // here it is too late for it.
  setenv("OMP_PROC_BIND", "false", 0);
  if (const char* const given = std::getenv("KOKKOS_NUM_THREADS"))
    if (const std::string_view text = given; text.empty() || text.size() > 5 || text[0] == '0' ||
                                             text.find_first_not_of("0123456789") != text.npos)
      throw InputError(
          fmt::format("KOKKOS_NUM_THREADS: expected a whole number of threads, got '{}'", text));
  Kokkos::InitializationSettings settings;
  if (threads > 0) settings.set_num_threads(threads);
  Kokkos::initialize(settings);
  ours = true;
}

void finalize_kokkos() {
  if (ours && Kokkos::is_initialized()) Kokkos::finalize();
  ours = false;
}

KokkosInfo kokkos_info() {
  start_kokkos();
  return {fmt::format("{}.{}.{}", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100,
                      KOKKOS_VERSION % 100),
          Exec::name(), Exec().concurrency()};
}

namespace {

namespace Tools = Kokkos::Tools::Experimental;
thread_local std::function<void()> call_between;

// Calls the function before kernels "plica::..." only: Kokkos' own kernels, such as those that make
// a view, may not throw
void before_kernel(const char* name, const std::uint32_t, std::uint64_t* number) {
  *number = 0;
  if (call_between && std::string_view(name).starts_with("plica::")) call_between();
}

bool listen_to_kernels() {
  if (Tools::get_callbacks().begin_parallel_for != nullptr)
    return false;  // a user's profiling tool
  Tools::set_begin_parallel_for_callback(before_kernel);
  Tools::set_begin_parallel_reduce_callback(before_kernel);
  return true;
}

}  // namespace

BetweenKernels::BetweenKernels(std::function<void()> call)
    : outer_(std::exchange(call_between, std::move(call))) {
  [[maybe_unused]] static const bool listens = listen_to_kernels();
}

BetweenKernels::~BetweenKernels() { call_between = std::move(outer_); }

}  // namespace plica::python
