// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <plica/drivers/run/simulation.hpp>

namespace plica::test {

/// Macro steps of a run that must stay sound: the test fails at the first that does not pass its
/// check.
template <class B>
void advance(Simulation<B>& simulation, int macro_steps) {
  for (int n = 0; n < macro_steps; ++n)
    if (const auto bad = simulation.step_checked()) {
      ADD_FAILURE() << "macro step " << n + 1 << ": " << bad->text();
      return;
    }
}

template <class B>
std::vector<Point> displacements(const Simulation<B>& simulation, const TetMesh& rest,
                                 int level = 0) {
  std::vector<Point> u = simulation.positions(level);
  for (std::size_t a = 0; a < u.size(); ++a) u[a] -= rest.vertices[a];
  return u;
}

}  // namespace plica::test
