// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Makes one level of each level of the whole body and those before it that cover a part
/// (Body::covers), see compose(). Afterwards `covers` is empty, and all levels cover the body. A
/// simulation does it by itself; functions of drivers/study expect it done.
///
/// A part that follows an obstacle starts where that one is at t = 0, and Body::following has what
/// it takes to make it anew. Regions are then chosen on the mesh that it is made of, and
/// RegionOptions::where is left out afterwards.
///
/// @param body     its levels are replaced
/// @param contact  obstacles that parts may follow
/// @return doubts, a sentence each, which begins with the level: "body.levels.0: the part ..."
/// @throw InputError where the last level covers a part, a selection chooses nothing, a part cannot
/// follow its obstacle, or compose() throws
std::vector<std::string> compose_levels(Body& body, const ContactOptions& contact = {});

/// Returns the number of the obstacle that a part follows. Throws InputError where there is none of
/// that name.
std::size_t followed_obstacle(const FollowOptions& follows, const ContactOptions& contact);

}  // namespace plica
