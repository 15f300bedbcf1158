// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/drivers/level/level.hpp>
#include <vector>

namespace plica {

/// Deforms level 0 as it starts, after limits were found at rest. Throws InputError where that
/// turns elements inside out which may not be.
/// @param mesh   all of level 0, placed
/// @param given  per vertex of it: its motion is given, and its place stays
template <class B>
void deform_start(const Body& body, const TetMesh& mesh, const std::vector<char>& given,
                  const Level<B>& level);

}  // namespace plica
