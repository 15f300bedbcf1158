// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <string>

/// The one Kokkos of a Python process: started when first needed, finalised when the interpreter
/// ends.
namespace plica::python {

/// Starts Kokkos; threads 0: as many as there are. Does nothing where it runs. InputError where it
/// runs with another number of threads, has come to its end, or another copy of its library is in
/// the process.
void start_kokkos(int threads = 0);

/// Ends it, if start_kokkos() has started it.
void finalize_kokkos();

/// What runs: "OpenMP", threads. Starts Kokkos.
struct KokkosInfo {
  std::string version, backend;
  int threads = 0;
};
KokkosInfo kokkos_info();

/// While this lives, calls a function before each kernel of the library that this thread launches.
/// What it throws comes out of the launch, so that a long macro step or set-up can be left. One at
/// a time.
class BetweenKernels {
 public:
  explicit BetweenKernels(std::function<void()> call);
  ~BetweenKernels();
  BetweenKernels(const BetweenKernels&) = delete;
  BetweenKernels& operator=(const BetweenKernels&) = delete;
};

}  // namespace plica::python
