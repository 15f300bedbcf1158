// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Measured limits of the machine, with all threads of the default execution space. Each is the
/// best of many short runs, since other load only ever adds time. Kokkos must be initialised.
namespace plica {

/// Returns the bandwidth of a(i) = b(i) + s c(i) [bytes/s]: two arrays read and one written, of
/// `footprint` bytes together.
double triad_bandwidth(double footprint);

/// Returns the rate of independent multiply-adds on vector registers [floating-point operations/s];
/// a multiply-add counts as two.
template <class Real>
double fma_peak();

}  // namespace plica
