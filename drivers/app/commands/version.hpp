// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>

namespace plica::app {

/// plica --version: ours, Kokkos and its back ends, compiler, commit.
std::string version_text();

}  // namespace plica::app
