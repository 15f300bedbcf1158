// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica {

/// Starts the program again, with threads that sleep soon while they wait for work. To be called
/// first in main(), with its argv, where other programs keep cores busy.
///
/// By default waiting threads of GNU's OpenMP spin for milliseconds, and keep cores from threads
/// that have work. They read the variable GOMP_SPINCOUNT when that library is loaded, which is
/// before main(): so it takes a second start to set it. Returns in the second start, and where the
/// environment has GOMP_SPINCOUNT or OMP_WAIT_POLICY already. Has no effect where there is no
/// /proc/self/exe.
void wait_passively(char** argv);

}  // namespace plica
