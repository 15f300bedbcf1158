// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/kinds.hpp>
#include <plica/drivers/app/scene/scene.hpp>

/// The keys below `integration`; see describe.hpp.
namespace plica::app {

std::vector<Choice> outside_rules();

template <class V>
void describe(V& v, ImplicitOptions& o) {
  v("solver", o.solver, Name{"solver", linear_solver_choices}, "of linear systems; auto: direct for small meshes");
  v("preconditioner", o.preconditioner, Name{"preconditioner", preconditioner_choices},
    "of conjugate gradients; auto: multigrid where the body has coarser levels");
  v("matrix", o.matrix, Name{"matrix", matrix_choices}, "how the system is kept; auto: assembled where that pays");
  v("polynomial_degree", o.polynomial_degree, Count{2}, "of chebyshev, and of the smoothing in multigrid; up to 16");
  v("relative_residual", o.relative_residual,
    Quantity{number, {.min = 0, .max = 1, .min_excluded = true, .max_excluded = true}}, "at which a linear solve ends");
  v("iterations", o.iterations, Count{0}, "above 0: exactly so many per linear solve, whatever the residual");
  v("max_iterations", o.max_iterations, Count{1}, "a solve that is not done by then is counted as a miss");
  v("newton_iterations", o.newton_iterations, AutoCount{},
    "per step, at most; 1: linearly implicit; auto: 20 where the integrator conserves energy, else 1");
  v("newton_tolerance", o.newton_tolerance, Quantity{number, positive}, "of the residual, relative to the first");
  v("newton_residual", o.newton_residual, Quantity{force, not_negative},
    "or, where that is less strict, this residual");
  v("tangent", o.tangent, Name{"tangent", tangents}, "of the elements, that linear systems are made of");
  v("unfinished", o.unfinished, Name{"outcome", newton_outcomes}, "of a step that Newton's method does not solve");
  v("halvings", o.halvings, Count{1}, "of such a step, at most, with halve; up to 20; the shortest are accepted");
  v("rho_infinity", o.rho_infinity, Quantity{number, {.min = 0, .max = 1}},
    "of generalized_alpha: what a step leaves of the fastest motion");
}

template <class V>
void describe(V& v, HimOptions& o) {
  v("sigma", o.sigma, Quantity{number, {.min = 0, .max = 1, .min_excluded = true, .max_excluded = true}},
    "part of its stability limit that a step uses at rest; the rest is room for stiffening");
  v("dissipation", o.dissipation, AutoQuantity{{number, {.min = 0, .max = 1, .max_excluded = true}}},
    "of slowed motion, per step; auto: 1e-4 where the body turns");
  v("smoothing", o.smoothing, Flag{}, "of its transfers between the levels");
}

template <class V>
void describe(V& v, RetryOptions& o) {
  v("halvings", o.halvings, Count{0}, "of a macro step that does not pass its checks, 0 to 10; 0: the run ends there");
}

template <class V>
void describe(V& v, IntegrationOptions& o) {
  v("cycle", o.cycle, Name{"cycle", cycle_choices}, "how the levels share a macro step; auto: chosen by short trials");
  v("error_class", o.error_class, Name{"error class", error_classes}, "of cycle auto: how far from level 0 alone");
  v("macro_step", o.macro_step, AutoQuantity{{duration, positive}}, "auto: 0.9 of the predicted limit");
  v("distribution", Shares::Target{o.distribution, o.shares}, Shares{{"distribution", distributions}},
    "how much of the macro step each level integrates");
  v("shift_to_coarsest", o.shift_to_coarsest, Quantity{number, {.min = 0, .max = 1, .max_excluded = true}},
    "this part of every finer level's share goes to the coarsest");
  v("integrator", o.integrator, NamePerLevel{{"integrator", integrators}}, "each level's own");
  v("substeps", o.substeps, AutoCountPerLevel{}, "auto: as many as the level's limit asks for");
  v("safety", o.safety, Quantity{number, {.min = 0, .max = 1, .min_excluded = true}}, "of that limit that auto keeps");
  v("allow_unstable", o.allow_unstable, Flag{}, "run explicit sub-steps above their limit all the same");
  v("switch_threshold", o.switch_threshold, Quantity{number, positive},
    "of the switched mappings: drift over the local edge length");
  v("outside", o.outside, Name{"rule", outside_rules}, "for vertices outside the other level's mesh");
  v.group("implicit", o.implicit, "how implicit levels are solved");
  v.group("him", o.him, "of the cycle him");
  v.group("retry", o.retry, "of bad macro steps, by halves");
}

}  // namespace plica::app
