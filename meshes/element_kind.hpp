// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <functional>
#include <plica/meshes/memory_file.hpp>
#include <span>
#include <string>

namespace plica {

/// A kind of element as a format numbers it.
struct ElementKind {
  int type;
  const char* name;
  int dimension;
  int vertices;  ///< 0: any number
  bool taken;    ///< first order, and a tetrahedron or of lower dimension
};

/// The kind with a number if we take it; else an InputError "WHO has type TYPE, a NAME; supported are ...".
const ElementKind& taken_kind(std::span<const ElementKind> kinds, std::int64_t type,
                              const std::function<std::string()>& who, const std::string& file, const Place& place);

}  // namespace plica
