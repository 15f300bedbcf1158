// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <Kokkos_Core.hpp>
#include <plica/version.hpp>

#include "case.hpp"
#include "suites.hpp"

// plica_bench, plica_bench_layouts [--benchmark_filter=force/.*] [--benchmark_out=FILE ...];
// OMP_NUM_THREADS sets the number of threads. The counters come from the median repetition;
// fraction_of_limit compares it with the larger of compulsory bytes over triad bandwidth (at that
// footprint) and flops over multiply-add peak, both measured in the same run.
int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  using Exec = Kokkos::DefaultExecutionSpace;
  benchmark::AddCustomContext("plica", std::string(plica::version()) + " " + plica::git_revision());
  benchmark::AddCustomContext("compiler", plica::compiler());
  benchmark::AddCustomContext("backend", Exec::name());
  benchmark::AddCustomContext("threads", std::to_string(Exec().concurrency()));
  benchmark::AddCustomContext("vector_bytes", std::to_string(PLICA_VECTOR_BYTES));
  plica::bench::register_limits();
#if defined(PLICA_BENCH_LAYOUTS)
  plica::bench::register_layouts();
#else
  plica::bench::register_kernels();
  plica::bench::register_steps();
  plica::bench::register_levels();
  plica::bench::register_scale();
  plica::bench::register_growth();
  plica::bench::register_ranks();
#endif
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  plica::bench::drop_fixture();
}
