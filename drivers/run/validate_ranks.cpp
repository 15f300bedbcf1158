// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/methods/steppers.hpp>
#include <plica/drivers/run/validate.hpp>

namespace plica {

namespace {

/// Returns a sentence: what a scene has, why that needs one process, and what runs on several.
std::string needs_one_process(const std::string& what, const std::string& expected) {
  return text(what, ", which runs on one process alone; expected ", expected, ", or one process");
}

/// A direct solver factorises all of a matrix, and each rank has its own rows.
std::string refused_solver(const ImplicitOptions& o) {
  return o.solver == "direct" ? needs_one_process("integration.implicit.solver is " + o.solver,
                                                  "conjugate_gradients")
                              : std::string();
}

std::string refused_methods(const IntegrationOptions& o) {
  if (o.cycle != Single::name && o.cycle != Him::name && !seeks_rest(o) &&
      !stepper_needs(o.cycle).coarse_states)
    return needs_one_process("integration.cycle is " + o.cycle,
                             "single, him, rest, rs, rv, rsv, rsv_sv or fas");
  return std::ranges::all_of(o.integrator, is_explicit) ? std::string()
                                                        : refused_solver(o.implicit);
}

std::string refused_him(const Problem& problem) {
  if (problem.integration.cycle != Him::name) return {};
  if (problem.body.parts.size() > 1)
    return needs_one_process("integration.cycle is him, with several bodies",
                             "another cycle or one body");
  return {};
}

std::string refused_loads(const std::vector<LoadOptions>& loads) {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::string load = text("body.loads.", i);
    if (std::holds_alternative<FollowerPressure>(loads[i].load))
      return needs_one_process(load + ".follower_pressure turns with the body", "traction");
    if (std::holds_alternative<EnclosedVolume>(loads[i].load))
      return needs_one_process(load + ".enclosed_volume is of all of a cavity", "traction");
  }
  return {};
}

std::string refused_contact(const Problem& problem) {
  const ContactOptions& contact = problem.contact;
  if (has_pairs(problem))
    return needs_one_process(contact.self ? "contact.self is true" : "contact.bodies is true",
                             "false");
  if (!contact.attachments.empty())
    return needs_one_process("contact.attachments ties bodies together", "none");
  if (contact.whole_surface == "always")
    return needs_one_process("contact.whole_surface is always", "never");
  for (std::size_t o = 0; o < contact.obstacles.size(); ++o)
    if (contact.obstacles[o].grasp)
      return needs_one_process(text("contact.obstacles.", o, ".grasp holds points"), "none");
  return {};
}

}  // namespace

std::string refused_by_ranks(const Problem& problem) {
  std::string why = refused_methods(problem.integration);
  if (why.empty()) why = refused_him(problem);
  if (why.empty()) why = refused_loads(problem.body.loads);
  if (why.empty()) why = refused_contact(problem);
  if (why.empty() && !problem.cuts.empty()) why = needs_one_process("cuts change the mesh", "none");
  const auto& levels = problem.body.levels;
  if (why.empty() && (!problem.body.covers.empty() || problem.body.following ||
                      (!levels.empty() && !levels.front().piece.empty())))
    why = needs_one_process("body.levels has a part that is finer", "levels of the whole body");
  return why;
}

}  // namespace plica
