// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>

// What this machine can do at best, with the threads of this run: measured when first asked for, in
// the same process as what is compared with it.
namespace plica::bench {

/// Bytes per second of a(i) = b(i) + s c(i) with three arrays of `footprint` bytes in all, two read
/// and one written.
double triad_bandwidth(double footprint);

/// Floating-point operations per second of independent fused multiply-adds, two each.
template <class Real>
double fma_peak();

/// The least time [s] in which `bytes` and `flops` can be dealt with.
template <class Real>
double least_time(double bytes, double flops) {
  const double moving = bytes / triad_bandwidth(bytes), computing = flops / fma_peak<Real>();
  return moving > computing ? moving : computing;
}

}  // namespace plica::bench
