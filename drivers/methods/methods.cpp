// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/steppers.hpp>

namespace plica {

bool uses_coarse_levels(std::string_view cycle) { return stepper_needs(cycle).coarse_meshes; }
bool integrates_coarse_levels(std::string_view cycle) { return stepper_needs(cycle).coarse_states; }

std::size_t integrated_levels(std::string_view cycle, std::size_t levels) {
  return integrates_coarse_levels(cycle) ? levels : 1;
}

bool is_explicit(std::string_view integrator) {
  bool is = true;
  Integrators::visit(integrator, [&](auto member) { is = decltype(member)::is_explicit; });
  return is;
}

bool conserves_energy(const ImplicitOptions& options, std::string_view integrator) {
  bool conserves = false;
  Integrators::visit(integrator, [&](auto member) {
    if constexpr (requires { member.conserves(options); }) conserves = member.conserves(options);
  });
  return conserves;
}

int newton_iterations(const ImplicitOptions& options, std::string_view integrator) {
  constexpr int enough = 20;
  if (options.newton_iterations > 0) return options.newton_iterations;
  bool fixed = options.iterations > 0 || options.solver == "v_cycle";
  Integrators::visit(integrator, [&](auto member) {
    fixed = fixed || requires { member.linear_solver; };
  });
  return fixed && !conserves_energy(options, integrator) ? 1 : enough;
}

int most_halvings(const Problem& problem) {
  constexpr int enough = 6;
  const IntegrationOptions& o = problem.integration;
  if (o.on_failure.halvings != FailureOptions::automatic) return o.on_failure.halvings;
  const bool touches =
      !problem.contact.obstacles.empty() || !problem.body.parts.empty() || problem.contact.self;
  const bool judged = std::ranges::any_of(o.integrator, [&](const std::string& name) {
    return !is_explicit(name) && (touches || newton_iterations(o.implicit, name) > 1);
  });
  return judged ? enough : 0;
}

double rho_infinity(const ImplicitOptions& options, bool contact) {
  return options.rho_infinity.value_or(contact ? 0 : 0.8);
}

void check_length(const std::string& option, std::size_t size, std::size_t levels,
                  bool one_for_all) {
  if (size == levels || (size == 1 && one_for_all)) return;
  throw InputError(option + ": expected " + (one_for_all ? "one for all or " : "") +
                   "one for each level (" + std::to_string(levels) +
                   " in body.levels), got a list of " + std::to_string(size));
}

}  // namespace plica
