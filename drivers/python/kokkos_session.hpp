// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <string>

/// Kokkos in a Python process: there is one, started when it is first needed and finalised when the
/// interpreter ends.
namespace plica::python {

/// Starts Kokkos, unless it runs already; threads 0: all that there are. Throws InputError if
/// Kokkos runs with another number of threads or was finalised, or if the process has two copies of
/// its library.
void start_kokkos(int threads = 0);

/// Finalises Kokkos, if start_kokkos() has started it.
void finalize_kokkos();

/// Version of Kokkos, back end such as "OpenMP", and number of threads.
struct KokkosInfo {
  std::string version, backend;
  int threads = 0;
};
/// Starts Kokkos and returns its version, back end and number of threads.
KokkosInfo kokkos_info();

/// Calls a function before each kernel of the library that this thread launches, while the object
/// exists. An exception of the function leaves the launch: so a long macro step or set-up can be
/// interrupted. Objects of a thread may nest; the inner one's function is called.
class BetweenKernels {
 public:
  explicit BetweenKernels(std::function<void()> call);
  ~BetweenKernels();
  BetweenKernels(const BetweenKernels&) = delete;
  BetweenKernels& operator=(const BetweenKernels&) = delete;

 private:
  std::function<void()> outer_;
};

}  // namespace plica::python
