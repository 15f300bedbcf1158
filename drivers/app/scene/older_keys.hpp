// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/tree.hpp>
#include <string>
#include <vector>

// Keys of scenes that have an older name. It still works: the scene is read as if it had the
// present one, and a warning names that.
namespace plica::app {

/// Gives every key of a scene its present name; Tree::older_key keeps the one that was given.
/// InputError where a map has both.
void use_present_keys(Tree& scene);

/// Puts a value where "body.material.young_modulus=30 kPa" says, as override_value(), by older
/// names or present ones of keys.
void set_value(Tree& scene, const std::string& assignment, const std::string& label);

/// A sentence for each older name in a scene: where it first stands, and the present one.
std::vector<std::string> warnings_of_older_keys(const Tree& scene);

}  // namespace plica::app
