// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>

/// The one Kokkos of a Python process: started when first needed, finalised when the interpreter ends.
namespace plica::python {

/// Starts Kokkos; threads 0: as many as there are. Does nothing where it runs. InputError where it runs with another number of
/// threads, has come to its end, or another copy of its library is in the process.
void start_kokkos(int threads = 0);

/// Ends it, if start_kokkos() has started it.
void finalize_kokkos();

/// What runs: "OpenMP", threads. Starts Kokkos.
struct KokkosInfo {
  std::string version, backend;
  int threads = 0;
};
KokkosInfo kokkos_info();

}  // namespace plica::python
