// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/solver/presets.hpp>

namespace plica {

std::vector<Choice> presets() {
  return {
      {"tled",
       "total Lagrangian explicit dynamics (Miller et al. 2007, Taylor, Cheng & Ourselin 2008): body.element linear, "
       "integration.cycle single, integration.integrator central_difference, integration.relaxation backward_euler"}};
}

void apply_preset(std::string_view name, Problem& problem) {
  if (name != "tled") throw InputError(unknown_name("preset", name, names(presets())));
  problem.preset = name;
  problem.body.element = {"linear"};
  problem.integration.cycle = "single";
  problem.integration.integrator = {"central_difference"};
  problem.integration.relaxation = "backward_euler";
}

}  // namespace plica
