// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace plica::app {

/// What measurements were made on.
struct StudyMachine {
  std::string cpu;
  int cores = 0;
  std::string backend;
  int threads = 0;  ///< at most
};

/// This one. Needs Kokkos.
StudyMachine this_machine();

/// plica --version: the program, Kokkos and its back ends, the compiler, the commit.
std::string version_text();

/// With the program that measured.
nlohmann::ordered_json machine_json(const StudyMachine& machine);

}  // namespace plica::app
