// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What the machine can do at most, measured: all threads of the default execution space, the best
/// of many short runs, since what else goes on only ever adds time. Kokkos must be initialised.
namespace plica {

/// a(i) = b(i) + s c(i): bytes per second, two arrays read and one written, of `footprint` bytes
/// together.
double triad_bandwidth(double footprint);

/// Independent multiply-adds on vector registers: floating-point operations per second, two each.
template <class Real>
double fma_peak();

}  // namespace plica
