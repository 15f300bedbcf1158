// SPDX-License-Identifier: BSD-3-Clause
// Whether Kokkos runs with symbols.cpp in the place of what this system lacks, and whether these do
// what they should: 0 or 1.
#include <Kokkos_Core.hpp>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>

extern "C" long __isoc23_strtol(const char*, char**, int);
extern "C" void _ZNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEE15_M_replace_coldEPcmPKcmm(
    void*, char*, std::size_t, const char*, std::size_t, std::size_t);

namespace {

int failures = 0;
void expect(bool good, const std::string& what) {
  if (good) return;
  std::cerr << "wrong: " << what << '\n';
  ++failures;
}

/// Every part of a string in the place of every other, before, behind and across it, longer and
/// shorter.
void check_replace() {
  const std::string letters = "abcdefgh";
  const std::size_t n = letters.size();
  for (std::size_t place = 0; place <= n; ++place)
    for (std::size_t old_size = 0; place + old_size <= n; ++old_size)
      for (std::size_t source = 0; source <= n; ++source)
        for (std::size_t size = 0; source + size <= n; ++size) {
          std::string text = letters;
          text.resize(2 * n);
          char* p = text.data();
          _ZNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEE15_M_replace_coldEPcmPKcmm(
              &text, p + place, old_size, p + source, size, n - place - old_size);
          const std::string right =
              std::string(letters).replace(place, old_size, letters.substr(source, size));
          text.resize(right.size());
          expect(text == right, "replace: " + text + " instead of " + right);
        }
}

void check_kokkos() {
  Kokkos::initialize(
      Kokkos::InitializationSettings().set_num_threads(2).set_disable_warnings(true));
  {
    const Kokkos::View<long*> values("values", 1000);
    Kokkos::parallel_for(
        "fill", 1000, KOKKOS_LAMBDA(int i) { values(i) = i; });
    long sum = 0;
    Kokkos::parallel_reduce(
        "sum", 1000, KOKKOS_LAMBDA(int i, long& partial) { partial += values(i); }, sum);
    expect(sum == 499500, "a sum of Kokkos is " + std::to_string(sum));
    std::ostringstream text;
    Kokkos::print_configuration(text);
    expect(!text.str().empty(), "Kokkos has no configuration");
  }
  Kokkos::finalize();
}

}  // namespace

int main() {
  char* end = nullptr;
  expect(__isoc23_strtol("-42 ms", &end, 10) == -42 && *end == ' ', "strtol");
  check_replace();
  check_kokkos();
  return failures == 0 ? 0 : 1;
}
