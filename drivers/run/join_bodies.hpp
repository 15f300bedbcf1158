// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <utility>
#include <vector>

namespace plica {

/// Several bodies as one of several parts, for one Simulation: level i has all their meshes of
/// level i, of a body with fewer levels its coarsest. A body's regions become NAME and NAME/REGION,
/// with its material; its vertex sets NAME/SET, and NAME for all of it; what it selects, it selects
/// in itself. Each is placed. InputError, which names the body, where they differ in what a
/// simulation has once: the law, elements, pressure; for a body that starts stretched, twisted or
/// random; for names that repeat.
Body join_bodies(const std::vector<std::pair<std::string, Body>>& bodies);

}  // namespace plica
