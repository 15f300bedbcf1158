// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/rest.hpp>

namespace plica {

namespace {

constexpr int load_steps = 10;        // macro steps up to the whole loads
constexpr int most_cuts = 8;          // halvings of a load step
constexpr double whole_loads_at = 1;  // time of the whole loads where none is given [s]

double ramp_of(const RestOptions& options) { return options.ramp.value_or(whole_loads_at); }

/// Makes a Prony series relax at once, next to any load step.
void relax_at_once(std::vector<PronyTerm>& prony, double ramp) {
  constexpr double at_once = 1e-12;
  for (PronyTerm& term : prony) term.tau = at_once * ramp;
}

}  // namespace

bool seeks_rest(const IntegrationOptions& options) { return options.cycle == "rest"; }

LoadCourse course_to_rest(const RestOptions& options) {
  return PolygonCourse{{{0, 0}, {ramp_of(options), 1}}};
}

Problem problem_at_rest(Problem problem) {
  IntegrationOptions& o = problem.integration;
  if (!seeks_rest(o)) return problem;
  const double ramp = ramp_of(o.rest);
  o.integrator = {ImplicitEuler::name};
  if (!o.macro_step) o.macro_step = ramp / load_steps;
  if (o.on_failure.halvings == FailureOptions::automatic) o.on_failure.halvings = most_cuts;
  o.on_failure.unsolved = "stop";
  problem.body.damping = {};
  problem.contact.damping_scale = problem.contact.tangential_damping_scale = 0;
  for (LoadOptions& load : problem.body.loads)
    if (std::holds_alternative<ConstantCourse>(load.course)) load.course = course_to_rest(o.rest);
  relax_at_once(problem.body.material.prony, ramp);
  for (auto& [name, region] : problem.body.regions)
    region.damping = {}, relax_at_once(region.prony, ramp);
  for (BodyPart& part : problem.body.parts) relax_at_once(part.material.prony, ramp);
  return problem;
}

}  // namespace plica
