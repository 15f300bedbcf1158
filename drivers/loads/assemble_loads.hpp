// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/elastic/level_constants.hpp>
#include <vector>

namespace plica {

/// What a load is on one level, at factor 1, at rest.
struct AssembledLoad {
  std::vector<int> vertex;
  std::vector<Point> force;         ///< [N]
  Point resultant = Point::Zero();  ///< their sum [N]
};

/// Whether pressures follow the body, given or of fluids in it.
bool has_follower_loads(const Body& body);

/// All loads on a level's mesh at rest. A traction is integrated over the level's own boundary and
/// scaled to the resultant it has on level 0, `finest`, which is empty there: loads do not depend
/// on the resolution. InputError where a load finds nothing to act on, or nothing that is free to
/// move.
std::vector<AssembledLoad> assemble_loads(const Body& body, const TetMesh& mesh,
                                          const LevelConstants& constants, int level,
                                          const std::vector<AssembledLoad>& finest);

/// The dead ones among them.
template <class B>
std::vector<Load<B>> device_loads(const Body& body, const std::vector<AssembledLoad>& loads);

/// The pressures that follow the body, given or of fluids in it, on a level's mesh at rest.
template <class B>
std::vector<FollowerLoad<B>> follower_loads(const Body& body, const TetMesh& mesh,
                                            const LevelConstants& constants, int level);

}  // namespace plica
