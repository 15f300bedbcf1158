// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <sys/resource.h>

#include <cstddef>

namespace plica::app {

/// Returns the maximum memory that this process has had at a time [bytes].
inline std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace plica::app
