// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/scene.hpp>
#include <string>

namespace plica::app {

/// Sets a scene up and returns the text of `plica explain`. Needs Kokkos. Throws InputError with
/// the location in the scene.
std::string explained(const Scene& scene, const std::string& precision);

/// Sets a scene up without the trials of cycle auto, and returns the JSON of `plica check`. Needs
/// Kokkos. Throws InputError with the location in the scene.
std::string checked_json(const Scene& scene, const std::string& precision);

}  // namespace plica::app
