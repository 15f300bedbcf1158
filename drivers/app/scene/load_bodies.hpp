// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/load_scene.hpp>

namespace plica::app {

/// A scene with `bodies`: each is read and built as a scene's `body`, then they are joined. See join_bodies().
Scene load_bodies(const Tree& tree);

}  // namespace plica::app
