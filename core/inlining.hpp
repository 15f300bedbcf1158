// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// PLICA_FLATTEN stands before a function of packs that a loop calls: the compiler then inlines all
// that it calls, so that packs stay in registers. By its own measure it stops inlining once a
// source uses the small functions of packs often, and every pack goes through memory: the elastic
// force took 1.7 times as long. Long functions below that are seldom run are marked PLICA_SELDOM
// and stay calls; those that are run, but need not be compiled into every caller, PLICA_CALL.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define PLICA_FLATTEN __attribute__((flatten))
#define PLICA_SELDOM __attribute__((noinline, cold))
#define PLICA_CALL __attribute__((noinline))
#else
#define PLICA_FLATTEN
#define PLICA_SELDOM
#define PLICA_CALL
#endif
