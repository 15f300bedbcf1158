// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>

namespace plica {

/// The problem of its small motions about rest: every material is `linear`, nothing acts but elasticity and damping, given
/// motions stand still, mappings never switch, implicit levels solve to 1e-12; at the macro step, the shares and the sub-steps of
/// the whole problem, also above a limit. InputError where that is refused.
template <class B>
Problem about_rest(Problem problem, const typename B::Exec& exec);

}  // namespace plica
