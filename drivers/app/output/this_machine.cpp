// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/this_machine.hpp>
#include <plica/version.hpp>
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

nlohmann::ordered_json machine_json(const StudyMachine& machine) {
  return {
      {"cpu", machine.cpu},     {"cores", machine.cores}, {"backend", machine.backend},    {"threads", machine.threads},
      {"compiler", compiler()}, {"version", version()},   {"git_revision", git_revision()}};
}

}  // namespace plica::app
