// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/tree.hpp>

namespace plica::app {

/// Returns the scene with one `integration` for all bodies: bodies.NAME.integration put over
/// `integration`. The bodies then have none. Bodies are stepped together, so all that have one must
/// give the same values. Throws InputError with the key and both values if they differ. A scene
/// whose bodies have no `integration` is returned unchanged.
Tree shared_integration(const Tree& tree);

/// Loads a scene with `bodies`: reads and builds each like a scene's `body`, then joins them. See
/// join_bodies().
Scene load_bodies(const Tree& tree);

}  // namespace plica::app
