// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/commands/commands.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// plica list: the members of a family, or all keys of a scene. InputError for an unknown family.
ExitStatus list(const std::string& family, bool json);

/// plica list without a family: what can be listed.
ExitStatus list_families(bool json);

/// The same, one line each, and the names alone.
std::string families_text();
std::vector<std::string> list_names();

}  // namespace plica::app
