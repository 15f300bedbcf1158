// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <utility>
#include <vector>

namespace plica {

/// Joins several bodies to one of several parts, for one Simulation. Level i has the meshes of
/// level i of all bodies; a body with fewer levels gives its coarsest. A body's regions become NAME
/// and NAME/REGION, with its material. Its vertex sets become NAME/SET, and NAME for all of it.
/// What it selects, it selects in itself. Each body is placed.
///
/// Throws InputError, which names the body, where bodies differ in what a simulation has once: the
/// law, elements, pressure. Throws it also for a body that starts stretched, twisted or random, and
/// for names that repeat.
Body join_bodies(const std::vector<std::pair<std::string, Body>>& bodies);

}  // namespace plica
