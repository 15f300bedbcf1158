// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/problem.hpp>
#include <plica/drivers/cycles/stepper.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <vector>

namespace plica {

/// A body ready to move, with what was decided on the way.
template <class B>
struct BuiltHierarchy {
  std::unique_ptr<Hierarchy<B>> hierarchy;
  std::unique_ptr<Stepper<B>> stepper;
  std::vector<TetMesh> meshes;  ///< placed, of the levels in use
  std::vector<LevelReport> reports;
  double macro_step = 0;         ///< [s]
  std::optional<HimReport> him;  ///< of that stepper
};

/// Builds a valid problem's levels, transfers, contact, integrators and stepper, and lets that plan
/// its steps. Throws InputError.
template <class B>
BuiltHierarchy<B> build_hierarchy(const Problem& problem, const typename B::Exec& exec);

}  // namespace plica
