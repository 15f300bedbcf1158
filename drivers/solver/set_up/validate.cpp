// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/expect.hpp>
#include <plica/drivers/solver/set_up/initial_shape.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/drivers/solver/set_up/validate_inputs.hpp>
#include <plica/drivers/solver/set_up/validate_linear_solver.hpp>
#include <plica/drivers/solver/set_up/validate_mesh.hpp>

namespace plica {

namespace {

void known(const std::string& kind, const std::string& name, const std::vector<Choice>& choices) {
  const auto all = names(choices);
  if (std::find(all.begin(), all.end(), name) == all.end()) throw InputError(unknown_name(kind, name, all));
}

void check_constants(const std::string& at, double young, double poisson, double density) {
  positive(at + "young_modulus", young, " Pa");
  expect(poisson >= 0 && poisson < 0.5, at + "poisson_ratio", poisson, "0 or more and below 0.5");
  positive(at + "density", density, " kg/m^3");
}

void check_damping(const std::string& at, double mass, double stiffness) {
  not_negative(at + "mass", mass, " 1/s");
  not_negative(at + "stiffness", stiffness, " s");
}

void check_body(const Body& body) {
  if (body.levels.empty()) throw InputError("body.levels is empty; expected at least one mesh, finest first");
  for (std::size_t i = 0; i < body.levels.size(); ++i) validate_mesh(body.levels[i], static_cast<int>(i));
  known("material", body.material.model, materials());
  const MaterialOptions& m = body.material;
  check_constants("body.material.", m.young_modulus, m.poisson_ratio, m.density);
  for (const auto& [name, region] : body.regions) {
    const auto& all = body.levels.front().region_names;
    if (region.where)
      validate_selection("body.regions." + name + ".where", *region.where);
    else if (std::find(all.begin(), all.end(), name) == all.end())
      throw InputError(unknown_name("region", name, all));
    check_constants("body.regions." + name + ".", region.young_modulus.value_or(m.young_modulus),
                    region.poisson_ratio.value_or(m.poisson_ratio), region.density.value_or(m.density));
    check_damping("body.regions." + name + ".damping.", region.damping.mass.value_or(0),
                  region.damping.stiffness.value_or(0));
  }
  check_damping("body.damping.", body.damping.mass, body.damping.stiffness);
  if (body.initial.position) finite("body.initial.position", *body.initial.position);
  validate_velocities(body.initial);
  const auto numbered = [](const char* list, std::size_t i) { return std::string(list) + "." + std::to_string(i); };
  for (std::size_t i = 0; i < body.fixed.size(); ++i) validate_selection(numbered("body.fixed", i), body.fixed[i]);
  for (std::size_t i = 0; i < body.prescribed.size(); ++i) {
    validate_selection(numbered("body.prescribed", i), body.prescribed[i].where);
    validate_motion(numbered("body.prescribed", i), body.prescribed[i].motion);
  }
  for (std::size_t i = 0; i < body.loads.size(); ++i) validate_load(numbered("body.loads", i), body.loads[i]);
}

void check_lengths(const IntegrationOptions& o, std::size_t levels) {
  const auto check = [&](const std::string& option, std::size_t size) {
    if (size != 1 && size != levels)
      throw InputError(option + " has " + std::to_string(size) + " entries for " + std::to_string(levels) +
                       " levels; expected one for all, or one each, finest first");
  };
  check("integration.integrator", o.integrator.size());
  check("integration.substeps", o.substeps.size());
}

[[noreturn]] void refuse(const IntegrationOptions& o, const char* key, const std::string& value, const char* why) {
  throw InputError("integration." + std::string(key) + " is " + value + ", but cycle " + o.cycle + " " + why +
                   "; leave it out");
}

void check_him(const IntegrationOptions& o) {
  expect(o.him.sigma > 0 && o.him.sigma < 1, "integration.him.sigma", o.him.sigma, "above 0 and below 1");
  const double loss = o.him.dissipation.value_or(0);
  expect(loss >= 0 && loss < 1, "integration.him.dissipation", loss, "auto, or 0 or more and below 1");
  if (o.cycle != "him") return;
  for (const std::string& name : o.integrator)
    if (name != "symplectic_euler") refuse(o, "integrator", name, "steps level 0 by leapfrog and no other level");
  for (const int n : o.substeps)
    if (n > 1) refuse(o, "substeps", std::to_string(n), "takes one step per macro step");
  if (o.distribution != "critical") refuse(o, "distribution", o.distribution, "does not divide the macro step");
  if (o.shift_to_coarsest > 0) refuse(o, "shift_to_coarsest", "above 0", "does not divide the macro step");
  if (o.outside != "clamp") refuse(o, "outside", o.outside, "has transfers of its own");
}

void check_retry(const IntegrationOptions& o) {
  expect(o.retry.halvings >= 0 && o.retry.halvings <= 10, "integration.retry.halvings", o.retry.halvings, "0 to 10");
  if (o.retry.halvings > 0 && (o.cycle == "him" || o.cycle == "auto"))
    refuse(o, "retry.halvings", std::to_string(o.retry.halvings),
           o.cycle == "him" ? "fits its inertia to one macro step, and again by itself where stability is lost"
                            : "may choose him, which fits its inertia to one macro step");
}

void check_auto(const IntegrationOptions& o) {
  if (o.cycle != "auto") return;
  if (o.macro_step) refuse(o, "macro_step", number(*o.macro_step) + " s", "chooses the macro step");
  for (const std::string& name : o.integrator)
    if (name != "symplectic_euler") refuse(o, "integrator", name, "chooses how levels are stepped");
  for (const int n : o.substeps)
    if (n > 1) refuse(o, "substeps", std::to_string(n), "chooses how levels are stepped");
  if (o.distribution != "critical") refuse(o, "distribution", o.distribution, "does not divide the macro step");
  if (o.shift_to_coarsest > 0) refuse(o, "shift_to_coarsest", "above 0", "does not divide the macro step");
  if (o.allow_unstable) refuse(o, "allow_unstable", "true", "chooses among stable steps");
  if (o.outside != "clamp") refuse(o, "outside", o.outside, "has transfers of its own");
}

void check_integration(const IntegrationOptions& o, std::size_t levels) {
  known("cycle", o.cycle, cycle_choices());
  known("error class", o.error_class, error_classes());
  known("distribution", o.distribution, distributions());
  for (const std::string& name : o.integrator) known("integrator", name, integrators());
  check_lengths(o, levels);
  if (o.macro_step) positive("integration.macro_step", *o.macro_step, " s");
  expect(o.shift_to_coarsest >= 0 && o.shift_to_coarsest < 1, "integration.shift_to_coarsest", o.shift_to_coarsest,
         "0 or more and below 1");
  for (int n : o.substeps) expect(n >= 0, "integration.substeps", n, "auto, or a number from 1");
  expect(o.safety > 0 && o.safety <= 1, "integration.safety", o.safety, "above 0, at most 1");
  positive("integration.switch_threshold", o.switch_threshold, "");
  known("treatment of outside vertices", o.outside, {{"clamp", ""}, {"extrapolate", ""}, {"keep", ""}});
  if (o.cycle == "fas" && o.outside != "clamp" && levels > 1)
    throw InputError("integration.outside is " + o.outside +
                     ", but cycle fas hands masses down by its weights, which "
                     "must not be negative or missing; expected clamp");
  check_him(o);
  check_auto(o);
  check_retry(o);
  const ImplicitOptions& i = o.implicit;
  expect(i.relative_residual > 0 && i.relative_residual < 1, "integration.implicit.relative_residual",
         i.relative_residual, "above 0 and below 1");
  expect(i.iterations >= 0, "integration.implicit.iterations", i.iterations, "0 or more");
  expect(i.max_iterations >= 1, "integration.implicit.max_iterations", i.max_iterations, "1 or more");
  expect(i.newton_iterations >= 0, "integration.implicit.newton_iterations", i.newton_iterations,
         "auto, or a number from 1");
  positive("integration.implicit.newton_tolerance", i.newton_tolerance, "");
  not_negative("integration.implicit.newton_residual", i.newton_residual, " N");
  known("tangent", i.tangent, tangents());
  known("outcome of Newton's method", i.unfinished, newton_outcomes());
  expect(i.halvings >= 1 && i.halvings <= 20, "integration.implicit.halvings", i.halvings, "1 to 20");
  expect(i.rho_infinity >= 0 && i.rho_infinity <= 1, "integration.implicit.rho_infinity", i.rho_infinity, "0 to 1");
  const bool judged = std::ranges::any_of(
      o.integrator, [&](const std::string& integrator) { return newton_iterations(i, integrator) > 1; });
  if (i.unfinished != "accept" && !judged)
    throw InputError("integration.implicit.unfinished is " + i.unfinished + ", but newton_iterations is " +
                     (i.newton_iterations == 0 ? "auto, here 1" : "1") +
                     ": a linearly implicit step has no residual to judge; expected newton_iterations above 1, or "
                     "accept");
}

void check_contact(const Problem& problem) {
  const ContactOptions& c = problem.contact;
  if (!c.obstacles.empty() && !problem.body.surface)
    throw InputError("contact has obstacles but the body has no surface to touch them with; expected body.surface");
  if (!c.obstacles.empty() && problem.body.surface->triangles.empty())
    throw InputError("body.surface has no triangle; contact needs its area");
  for (std::size_t i = 0; i < c.obstacles.size(); ++i)
    validate_obstacle("contact.obstacles." + std::to_string(i), c.obstacles[i]);
  positive("contact.stiffness_scale", c.stiffness_scale, "");
  not_negative("contact.damping_scale", c.damping_scale, "");
  not_negative("contact.tangential_damping_scale", c.tangential_damping_scale, "");
}

}  // namespace

void validate(const Problem& problem) {
  check_body(problem.body);
  finite("gravity", problem.gravity);
  check_integration(problem.integration, problem.body.levels.size());
  validate_linear_solver(problem);
  if (damps_by_stiffness(problem.body) && problem.integration.cycle == "him")
    throw InputError(
        "body.damping.stiffness is above 0, but cycle him answers for the stability of forces without it; use "
        "body.damping.mass or another cycle");
  check_contact(problem);
}

std::vector<std::string> doubts(const Problem& problem) {
  std::vector<std::string> sentences;
  const std::vector<TetMesh>& levels = problem.body.levels;
  for (std::size_t i = 1; i < levels.size(); ++i)
    if (levels[i].tets.size() >= levels[i - 1].tets.size())
      sentences.push_back("body.levels: level " + std::to_string(i) + " is not coarser than level " +
                          std::to_string(i - 1) + ": " + std::to_string(levels[i].tets.size()) + " tetrahedra after " +
                          std::to_string(levels[i - 1].tets.size()) + "; expected the finest first");
  if (const Body& body = problem.body; starts_deformed(body.initial) && !recovers(body.material.model)) {
    const TetMesh& mesh = levels.front();
    const std::string inverted =
        inverted_at_start(mesh, initial_displacement(body.initial, mesh, bounding_box(mesh.vertices)));
    if (!inverted.empty())
      sentences.push_back("body.initial: " + inverted + "; " + body.material.model +
                          " has nothing that turns them back, they may stay so");
  }
  for (std::size_t i = 0; i < problem.body.prescribed.size(); ++i)
    if (const auto* path = std::get_if<PathMotion>(&problem.body.prescribed[i].motion);
        path && path->knots.front().displacement.norm() > 0)
      sentences.push_back("body.prescribed." + std::to_string(i) +
                          ".path does not start at [0, 0, 0]: the body is torn from its rest at once");
  return sentences;
}

}  // namespace plica
