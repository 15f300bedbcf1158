// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <plica/drivers/run/wait_passively.hpp>

namespace plica {

void wait_passively(char** argv) {
  for (const char* own : {"GOMP_SPINCOUNT", "OMP_WAIT_POLICY"})
    if (std::getenv(own)) return;  // the user has chosen, or this is the second start
  std::error_code none;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", none);
  if (none || setenv("GOMP_SPINCOUNT", "1000", 1) != 0) return;
  execv(self.c_str(), argv);  // returns on failure only; threads spin then
}

}  // namespace plica
