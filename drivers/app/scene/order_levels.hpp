// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/scene.hpp>

namespace plica::app {

/// Returns an order in which neighbours are close in memory. It is the mesh's own if that is as
/// good as a Hilbert curve, such as that of a grid.
Reordering better_order(const TetMesh& mesh);

/// Puts all levels in the order of locality_order(), which depends on the mesh alone. Does so where
/// the scene has `body.order: hilbert`.
void order_levels(Scene& scene);

}  // namespace plica::app
