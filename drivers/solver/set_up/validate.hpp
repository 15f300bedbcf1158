// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>

namespace plica {

/// Throws InputError for the first value out of its range, unknown name or combination without meaning: names the option as a
/// scene would ("body.material.young_modulus is -1 Pa; expected above 0").
void validate(const Problem& problem);

}  // namespace plica
