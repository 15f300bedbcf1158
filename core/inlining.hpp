// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// PLICA_FLATTEN stands before a function of packs that a loop calls. The compiler then inlines all
// that it calls, so that packs stay in registers. Without the mark it stops inlining, by its own
// measure, once a source uses the small functions of packs often. Every pack then goes through
// memory: the elastic force took 1.7 times as long. PLICA_SELDOM marks long functions that a
// flattened one calls seldom; they stay calls. PLICA_CALL marks functions that are run, but need
// not be compiled into every caller.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define PLICA_FLATTEN __attribute__((flatten))
#define PLICA_SELDOM __attribute__((noinline, cold))
#define PLICA_CALL __attribute__((noinline))
#else
#define PLICA_FLATTEN
#define PLICA_SELDOM
#define PLICA_CALL
#endif
