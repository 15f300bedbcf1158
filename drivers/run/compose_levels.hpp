// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Makes one level of each level of the whole body and those before it that cover a part
/// (Body::covers), see compose(). Afterwards `covers` is empty, and all levels cover the body. A
/// simulation does it by itself; functions of drivers/study expect it done.
///
/// @return doubts, a sentence each, which begins with the level: "body.levels.0: the part ..."
/// @throw InputError where the last level covers a part, a selection chooses nothing, or compose()
/// throws
std::vector<std::string> compose_levels(Body& body);

}  // namespace plica
