// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/problem.hpp>
#include <plica/core/ranks.hpp>
#include <plica/drivers/body/supports.hpp>
#include <plica/drivers/cycles/stepper.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <vector>

namespace plica {

/// A body that is ready to be stepped, with the decisions of its set-up.
template <class B>
struct BuiltHierarchy {
  std::unique_ptr<Hierarchy<B>> hierarchy;
  std::unique_ptr<Stepper<B>> stepper;
  std::vector<TetMesh> meshes;  ///< placed meshes of the levels in use
  std::vector<LevelReport> reports;
  /// Held vertices of level 0; their centres are placed. On one of several ranks: those it owns
  std::vector<HeldSet> held;
  /// [points] number of each point of level 0's surface, on one of several ranks; else empty
  std::vector<int> surface_point;
  std::vector<int> owned_points;  ///< local numbers of the points that the rank owns
  double macro_step = 0;          ///< length of a macro step [s]
  std::optional<HimReport> him;   ///< report of cycle him; none: another cycle
};

/// Builds a valid problem's levels, transfers, contact, integrators and stepper, and lets the
/// stepper plan its steps. Throws InputError.
/// @param ranks  ranks that the body is shared out to, all of which call this; null: one process.
///               Set-up is the same on all of them, and so are its errors
template <class B>
BuiltHierarchy<B> build_hierarchy(const Problem& problem, const typename B::Exec& exec,
                                  Ranks* ranks = nullptr);

}  // namespace plica
