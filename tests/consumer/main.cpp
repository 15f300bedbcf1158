// SPDX-License-Identifier: BSD-3-Clause
// A program outside Plica that links the installed library: a beam sags under its own weight.
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <iostream>
#include <plica/plica.hpp>

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  const plica::Box beam{{0, 0, 0}, {0.4, 0.1, 0.1}};  // m
  plica::Problem problem;
  problem.gravity = {0, 0, -9.81};
  problem.body.levels = {plica::box_mesh(beam, {16, 4, 4})};
  problem.body.material = {"neo_hookean", 1e6, 0.3, 1000};
  problem.body.fixed = {plica::Box{{0, 0, 0}, {0, 0.1, 0.1}}};
  try {
    plica::Simulation<plica::Backend<double, Kokkos::DefaultExecutionSpace>> simulation(problem);
    while (simulation.time() < 0.1)
      if (const auto failure = simulation.step_checked()) throw std::runtime_error(failure->text());
    double lowest = 0;
    for (const plica::Point& x : simulation.positions()) lowest = std::min(lowest, x[2]);
    std::cout << "plica " << plica::version() << ": after " << simulation.time()
              << " s the tip hangs " << -1e3 * lowest << " mm low\n";
    return lowest < -1e-3 && lowest > -0.1 ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
