// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/commands/exit_status.hpp>
#include <string>

namespace plica::app {

/// plica list: the members of a family, or all keys of a scene. InputError for an unknown family.
ExitStatus list(const std::string& family, bool json);

/// What can be listed, one line each.
std::string families_text();

}  // namespace plica::app
