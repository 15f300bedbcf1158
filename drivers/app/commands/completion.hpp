// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace plica::app {

/// plica completion: a script for `bash` or `zsh` that completes commands, options, and the names that arguments choose from.
/// InputError for another shell.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace plica::app
