// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/tree.hpp>

namespace plica::app {

/// The scene whose `integration` is that of its bodies, bodies.NAME.integration over `integration`,
/// and whose bodies have none. Bodies take one step together, so those that have one must come to
/// the same; the others follow. InputError with the key and both values where they differ. Without
/// any the scene stays as it is.
Tree shared_integration(const Tree& tree);

/// A scene with `bodies`: each is read and built as a scene's `body`, then they are joined. See
/// join_bodies().
Scene load_bodies(const Tree& tree);

}  // namespace plica::app
