// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <plica/core/backend.hpp>
#include <plica/drivers/app/output/machine.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/version.hpp>
#include <set>
#include <thread>

namespace plica::app {

namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown";
}

}  // namespace

StudyMachine this_machine() {
  using Exec = Kokkos::DefaultExecutionSpace;
  return {processor(), static_cast<int>(std::thread::hardware_concurrency()), Exec::name(), Exec().concurrency()};
}

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

nlohmann::ordered_json machine_json(const StudyMachine& machine) {
  return {
      {"cpu", machine.cpu},     {"cores", machine.cores}, {"backend", machine.backend},    {"threads", machine.threads},
      {"compiler", compiler()}, {"version", version()},   {"git_revision", git_revision()}};
}

}  // namespace plica::app
