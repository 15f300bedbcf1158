// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/solver/integrators/list.hpp>
#include <plica/drivers/solver/linear/list.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/plan_steps.hpp>
#include <plica/drivers/solver/spaces/coarse_spaces.hpp>
#include <plica/drivers/solver/steppers.hpp>
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

std::vector<Choice> unsolved_outcomes() {
  return {{"accept", "goes on, and counts it (newton_misses)"},
          {"stop", "ends the run: kind solver"}};
}

bool uses_coarse_levels(std::string_view cycle) { return stepper_needs(cycle).coarse_meshes; }
bool integrates_coarse_levels(std::string_view cycle) { return stepper_needs(cycle).coarse_states; }

bool has_coarse_levels(std::string_view cycle, const Body& body) {
  if (cycle != "auto" && !uses_coarse_levels(cycle)) return false;
  if (body.levels.size() > 1) return true;
  return !integrates_coarse_levels(cycle) &&
         !space_sizes(static_cast<int>(body.levels.front().vertices.size())).empty();
}

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
