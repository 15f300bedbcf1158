// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/set_up/build_hierarchy.hpp>
#include <plica/drivers/solver/set_up/build_level.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

namespace plica {

/// The cycle `him` on a built level 0: its spaces, its macro step, the inertia that goes with it; completes the reports.
/// @param constants  of all levels' meshes in built.meshes
/// @param up         [i]: level i-1's vertices in level i
/// InputError where no inertia makes the macro step stable, or the coarsest level is too large to be answered densely.
template <class B>
std::unique_ptr<Cycle<B>> make_him(const Problem& problem, const std::vector<LevelConstants>& constants,
                                   const std::vector<Embedding>& up, std::shared_ptr<const Elasticity<B>> elasticity,
                                   std::shared_ptr<const Contact<B>> contact, BuiltHierarchy<B>& built);

}  // namespace plica
