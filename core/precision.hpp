// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>
#include <plica/core/error.hpp>
#include <string>
#include <string_view>
#include <type_traits>

namespace plica {

/// Calls work(std::type_identity<B>()) with the backend of an execution space in the precision of
/// that name, and returns its result. InputError for a name that is neither float nor double, and
/// for float where the build has double alone.
template <class Exec, class Work>
auto in_precision(std::string_view name, const Work& work) {
  if (name != "float" && name != "double")
    throw InputError(unknown_name("precision", std::string(name), {"float", "double"}));
  if constexpr (is_built<float>)
    if (name == "float") return work(std::type_identity<Backend<float, Exec>>());
  if (name == "float")
    throw InputError(
        "precision is float, but this build has double alone; expected double, or a build with "
        "-DPLICA_BACKENDS=all");
  return work(std::type_identity<Backend<double, Exec>>());
}

}  // namespace plica
