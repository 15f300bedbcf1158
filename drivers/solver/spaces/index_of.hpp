// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>

namespace plica {

/// A number of a vertex, an element or an entry, as an index.
constexpr std::size_t index_of(int number) { return static_cast<std::size_t>(number); }

}  // namespace plica
