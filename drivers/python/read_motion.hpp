// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/motion.hpp>
#include <string>

namespace plica::python {

/// Reads a translation from JSON with the keys of a scene, all values as text: {"velocity": ["0",
/// "0", "1 mm/s"]}. Throws InputError for unknown keys and values out of range.
Motion read_motion(const std::string& json);
/// Reads a turn from JSON with the keys of a scene, all values as text. Throws InputError for
/// unknown keys and values out of range.
Turn read_turn(const std::string& json);

}  // namespace plica::python
