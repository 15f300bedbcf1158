// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/element_kind.hpp>

namespace plica {

const ElementKind& taken_kind(std::span<const ElementKind> kinds, std::int64_t type,
                              const std::function<std::string()>& who, const std::string& file, const Place& place) {
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const ElementKind& k) { return k.type == type; });
  if (kind != kinds.end() && kind->taken) return *kind;
  refuse(file, place,
         who() + " has type " + std::to_string(type) + (kind != kinds.end() ? ", a " + std::string(kind->name) : "") +
             "; supported are tetrahedra, and whatever is of lower dimension, of first order");
}

}  // namespace plica
