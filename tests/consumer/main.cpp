// SPDX-License-Identifier: BSD-3-Clause
// A program outside Plica that uses the installed library.
#include <Kokkos_Core.hpp>
#include <iostream>
#include <plica/core/mesh.hpp>
#include <plica/version.hpp>

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  const plica::Box box = plica::bounding_box({plica::Point(0, 0, 0), plica::Point(1, 2, 3)});
  std::cout << "plica " << plica::version() << " (" << plica::git_revision() << ", " << plica::compiler() << ")\n";
  return box.max == plica::Point(1, 2, 3) ? 0 : 1;
}
