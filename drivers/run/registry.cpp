// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/linear/list.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/steppers.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>

namespace plica {

namespace {

template <class List>
std::vector<Choice> choices() {
  std::vector<Choice> list;
  List::for_each([&](auto member) {
    list.push_back({decltype(member)::name, decltype(member)::summary});
  });
  return list;
}

}  // namespace

std::vector<Choice> integrators() { return choices<Integrators>(); }
std::vector<Choice> cycles() { return choices<Steppers>(); }
std::vector<Choice> error_classes() { return choices<ErrorClasses>(); }
std::vector<Choice> obstacle_shapes() { return choices<ObstacleShapes>(); }

std::vector<Choice> cycle_choices() {
  std::vector<Choice> list = cycles();
  list.push_back({"rest", "no motion: the equilibrium under the loads, which grow in load steps"});
  list.push_back({"auto",
                  "him or single, with its macro step: the longest that short trials find within "
                  "integration.error_class"});
  return list;
}

std::vector<Choice> distributions() {
  std::vector<Choice> list = choices<Distributions>();
  list.push_back({"custom", "a list of shares, finest first, that sum to 1"});
  return list;
}

std::vector<Choice> outside_rules() {
  return {{"clamp", "moves with the nearest point of the other mesh"},
          {"extrapolate", "continues the nearest tetrahedron"},
          {"keep", "keeps its own motion"}};
}

std::vector<Choice> relaxation_rules() {
  return {{"exponential", "exact where the stress is linear in time (Simo & Hughes 1998)"},
          {"backward_euler", "of first order, as in TLED (Taylor, Cheng & Ourselin 2008)"}};
}

std::vector<Choice> linear_solvers() { return choices<LinearSolvers>(); }
std::vector<Choice> preconditioners() { return choices<Preconditioners>(); }

std::vector<Choice> linear_solver_choices() {
  std::vector<Choice> list = linear_solvers();
  list.push_back({"auto", "direct for small meshes, else conjugate_gradients"});
  return list;
}

std::vector<Choice> preconditioner_choices() {
  std::vector<Choice> list = preconditioners();
  list.push_back({"auto",
                  "multigrid where the body has coarser levels, or one mesh and long steps; else "
                  "block_jacobi"});
  return list;
}

std::vector<Choice> whole_surface_rules() {
  return {{"auto",
           "those with a radius below 16 of the surface's mean edges; none where a linear solver "
           "is direct or v_cycle"},
          {"always", "all of them"},
          {"never", "none: what fits between points passes"}};
}

std::vector<Choice> matrix_choices() {
  return {{"free", "element by element, at every product"},
          {"assembled", "3x3 blocks by rows"},
          {"auto", "assembled, but for a few fixed iterations"}};
}

std::vector<Choice> tangents() {
  return {{"exact",
           "the derivative of the force; a solve takes no direction in which the body softens"},
          {"positive", "projected to positive semi-definite, element by element"},
          {"auto", "exact; projected where Newton's method finds that the body softens"}};
}

std::vector<Choice> axis_choices() {
  return {{"x", "[1, 0, 0]"}, {"y", "[0, 1, 0]"}, {"z", "[0, 0, 1]"}};
}

std::vector<Choice> unsolved_outcomes() {
  return {{"accept", "goes on, and counts it (newton_misses)"},
          {"stop", "ends the run: kind solver"}};
}

std::vector<Choice> presets() {
  return {{"tled",
           "total Lagrangian explicit dynamics (Miller et al. 2007, Taylor, Cheng & Ourselin "
           "2008): body.element linear, "
           "integration.cycle single, integration.integrator central_difference, "
           "integration.relaxation backward_euler"}};
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
