// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>

namespace plica::test {

/// Memory of views that behaves like a device's on a host: while it is closed, only kernels and
/// copies get at it. What else touches it goes on, and is written down. One at a time; Kokkos's
/// callbacks are its own meanwhile.
class DeviceMemory {
 public:
  /// Views allocated from now on lie in it.
  DeviceMemory();
  ~DeviceMemory();
  DeviceMemory(const DeviceMemory&) = delete;
  DeviceMemory& operator=(const DeviceMemory&) = delete;

  /// Labels of views that were touched from outside kernels while this ran.
  template <class Work>
  std::vector<std::string> touched_by(const Work& work) {
    close();
    work();
    return open();
  }

 private:
  void close();
  std::vector<std::string> open();
};

}  // namespace plica::test
