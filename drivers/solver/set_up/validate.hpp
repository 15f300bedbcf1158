// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Throws InputError for the first value out of its range, unknown name or combination without meaning: names the option as a
/// scene would ("body.material.young_modulus is -1 Pa; expected above 0").
void validate(const Problem& problem);

/// What is allowed, but hardly meant: a sentence each. Of a problem that is valid.
std::vector<std::string> doubts(const Problem& problem);

}  // namespace plica
