// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/set_up/build_hierarchy.hpp>
#include <vector>

namespace plica {

/// Which parts a scene's simulation consists of, each with the device memory it takes.
template <class B>
std::vector<Part> list_parts(const Problem& problem, const BuiltHierarchy<B>& built);

}  // namespace plica
