// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Kokkos_Core.hpp>
#include <plica/core/backend.hpp>
#include <plica/drivers/app/commands/version.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/version.hpp>
#include <set>

namespace plica::app {

std::string version_text() {
  std::set<std::string> backends;
#define PLICA_NAME(real, exec) backends.insert(exec::name());
  PLICA_FOR_EACH_BACKEND(PLICA_NAME)
#undef PLICA_NAME
  const std::string kokkos =
      fmt::format("{}.{}.{}; back ends {}; default {}", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100,
                  KOKKOS_VERSION % 100, fmt::join(backends, ", "), Kokkos::DefaultExecutionSpace::name());
  return text_table({{"plica", version()}, {"Kokkos", kokkos}, {"compiler", compiler()}, {"git", git_revision()}}, "<<",
                    "");
}

}  // namespace plica::app
