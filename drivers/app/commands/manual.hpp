// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>

namespace plica::app {

/// What `plica COMMAND --help` says beneath the options: what the command does with its input, files, examples, exit statuses.
std::string manual_of(const std::string& command);

}  // namespace plica::app
