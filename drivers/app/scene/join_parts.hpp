// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/scene.hpp>

namespace plica::app {

/// Makes one level of each level of the whole body and those before it that cover a part, see
/// compose_levels(). A level that was made so is numbered anew: the part's vertices come first.
/// Throws InputError with the location in the scene.
void join_parts(Scene& scene, const Tree& tree);

}  // namespace plica::app
