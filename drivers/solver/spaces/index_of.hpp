// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>

namespace plica {

/// A vertex' number as an index.
constexpr std::size_t index_of(int vertex) { return static_cast<std::size_t>(vertex); }

}  // namespace plica
