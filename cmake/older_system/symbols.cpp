// SPDX-License-Identifier: BSD-3-Clause
// What a library built with GNU 13 or 14 and glibc 2.38 or newer calls and Debian 12 does not have.
// cmake/unpack-kokkos makes of it a library that stands in for these few symbols.
#include <cstdlib>
#include <cstring>
#include <ios>
#include <string>

/// strtol of C23: it also reads "0b101" where the base is 0 or 2. Kokkos reads decimal numbers.
extern "C" long __isoc23_strtol(const char* text, char** end, int base) {
  return std::strtol(text, end, base);
}

namespace std {
/// Starts cin and cout, where headers no longer do that in every source.
void ios_base_library_init() { static const ios_base::Init once; }
}  // namespace std

/// std::string's replace, where the source lies in the string that is changed: `old_size`
/// characters at `place`, with `tail` more behind them, become the `size` characters at `source`.
/// There is room enough.
extern "C" void _ZNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEE15_M_replace_coldEPcmPKcmm(
    void* /*string*/, char* place, std::size_t old_size, const char* source, std::size_t size,
    std::size_t tail) {
  const std::string before_it_moves(source, size);
  std::memmove(place + size, place + old_size, tail);
  std::memcpy(place, before_it_moves.data(), size);
}
