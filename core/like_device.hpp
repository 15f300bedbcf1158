// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <cmath>

// A build for tests alone (tests/like_device) gives a CPU the kernels of a GPU. A thread then has
// one element, and a team several threads. Teams and work items are done in an order that the tests
// choose, because a GPU promises none. In all other builds nothing is left of this.
namespace plica::like_device {

#ifdef PLICA_LIKE_DEVICE

inline constexpr bool on = true;
inline int team = 4;  ///< threads of a team
/// Order in which a league's teams and a range's items are done; 0: one after the other
inline unsigned order = 0;

template <class Exec>
int team_size(int) {
  return Kokkos::min(team, Exec().concurrency());
}

/// Returns which of n things is done in place i: start + i * stride modulo n. The stride has no
/// factor in common with n.
inline int place(int i, int n) {
  if (order == 0 || n < 2) return i;
  const auto factor = [](unsigned a, unsigned b) {
    while (b > 0) {
      const unsigned rest = a % b;
      a = b, b = rest;
    }
    return a;
  };
  const unsigned hash = order * 2654435769u, size = static_cast<unsigned>(n);
  unsigned stride = 1 + (hash >> 8) % (size - 1);
  while (factor(stride, size) > 1) stride = stride % (size - 1) + 1;
  return static_cast<int>(
      (hash % size + static_cast<unsigned long long>(stride) * static_cast<unsigned>(i)) % size);
}

template <class Work>
struct Shuffled {
  int n;
  Work work;
  void operator()(int i) const { work(place(i, n)); }
};
/// Returns work on the items below n in the order of place().
template <class Work>
Shuffled<Work> shuffled(int n, const Work& work) {
  return {n, work};
}

/// Fills a team's memory with NaN, so that a test finds a read before the first write.
template <class Member, class Real>
void poison(const Member& member, Real* memory, std::size_t count) {
  Kokkos::parallel_for(Kokkos::TeamThreadRange(member, count),
                       [&](std::size_t i) { memory[i] = Real(NAN); });
  member.team_barrier();
}

#else

inline constexpr bool on = false;

template <class Exec>
constexpr int team_size(int on_device) {
  return on_device;
}
KOKKOS_INLINE_FUNCTION int place(int i, int) { return i; }
template <class Work>
const Work& shuffled(int, const Work& work) {
  return work;
}
template <class Member, class Real>
KOKKOS_INLINE_FUNCTION void poison(const Member&, Real*, std::size_t) {}

#endif

}  // namespace plica::like_device
