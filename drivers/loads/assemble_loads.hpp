// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/level_data.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/elastic/level_constants.hpp>
#include <plica/drivers/loads/force_term.hpp>
#include <vector>

namespace plica {

/// Forces of one load on one level, at factor 1, at rest.
struct AssembledLoad {
  std::vector<int> vertex;
  std::vector<Point> force;         ///< [N]
  Point resultant = Point::Zero();  ///< sum of the forces [N]
};

/// Returns whether pressures follow the body: given ones, or those of fluids in it.
bool has_follower_loads(const Body& body);

/// Returns all loads on a level's mesh at rest. A traction is integrated over the level's own
/// boundary and scaled to the resultant it has on level 0. So loads do not depend on the
/// resolution. Throws InputError where a load finds nothing to act on, or nothing that is free to
/// move.
/// @param finest  loads on level 0; empty for level 0 itself
std::vector<AssembledLoad> assemble_loads(const Body& body, const TetMesh& mesh,
                                          const LevelConstants& constants, int level,
                                          const std::vector<AssembledLoad>& finest);

/// Makes the force terms that a body's options ask for on a level, in the order in which they are
/// added; `loads` are those assembled on its mesh, which is at rest. A new kind of term is one more
/// entry here.
template <class B>
std::vector<std::unique_ptr<ForceTerm<B>>> make_force_terms(const Body& body, const TetMesh& mesh,
                                                            const LevelConstants& constants,
                                                            const std::vector<AssembledLoad>& loads,
                                                            int level);

}  // namespace plica
