// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/run/validate.hpp>

namespace plica {

using namespace keys;

namespace {

[[noreturn]] void refuse(const IntegrationOptions& o, const char* key, const std::string& value,
                         const char* why) {
  throw InputError("integration." + std::string(key) + " is " + value + ", but cycle " + o.cycle +
                   " " + why + "; leave it out");
}

void check_him(const IntegrationOptions& o) {
  if (o.cycle != "him") return;
  for (const std::string& name : o.integrator)
    if (name != "symplectic_euler")
      refuse(o, "integrator", name, "steps level 0 by leapfrog and no other level");
  for (const int n : o.substeps)
    if (n > 1) refuse(o, "substeps", std::to_string(n), "takes one step per macro step");
  if (o.distribution != "critical")
    refuse(o, "distribution", o.distribution, "does not divide the macro step");
  if (o.shift_to_coarsest > 0)
    refuse(o, "shift_to_coarsest", "above 0", "does not divide the macro step");
  if (o.outside != "clamp") refuse(o, "outside", o.outside, "has transfers of its own");
}

void check_failure(const IntegrationOptions& o) {
  if (o.on_failure.halvings > 0 && (o.cycle == "him" || o.cycle == "auto"))
    refuse(o, "on_failure.halvings", std::to_string(o.on_failure.halvings),
           o.cycle == "him"
               ? "fits its inertia to one macro step, and again by itself where stability is lost"
               : "may choose him, which fits its inertia to one macro step");
}

void check_auto(const IntegrationOptions& o) {
  if (o.cycle != "auto") return;
  if (o.macro_step) refuse(o, "macro_step", number(*o.macro_step) + " s", "chooses the macro step");
  for (const std::string& name : o.integrator)
    if (name != "symplectic_euler") refuse(o, "integrator", name, "chooses how levels are stepped");
  for (const int n : o.substeps)
    if (n > 1) refuse(o, "substeps", std::to_string(n), "chooses how levels are stepped");
  if (o.distribution != "critical")
    refuse(o, "distribution", o.distribution, "does not divide the macro step");
  if (o.shift_to_coarsest > 0)
    refuse(o, "shift_to_coarsest", "above 0", "does not divide the macro step");
  if (o.allow_unstable) refuse(o, "allow_unstable", "true", "chooses among stable steps");
  if (o.outside != "clamp") refuse(o, "outside", o.outside, "has transfers of its own");
}

void check_rest(const IntegrationOptions& o) {
  if (!seeks_rest(o)) return;
  const auto refuse_here = [&](const char* key, const std::string& value) {
    refuse(o, key, value, "has no motion, and solves each load step by Newton's method");
  };
  for (const std::string& name : o.integrator)
    if (name != "symplectic_euler") refuse_here("integrator", name);
  for (const int n : o.substeps)
    if (n > 1) refuse_here("substeps", std::to_string(n));
  if (o.distribution != "critical") refuse_here("distribution", o.distribution);
  if (o.shift_to_coarsest > 0) refuse_here("shift_to_coarsest", "above 0");
  const ImplicitOptions& implicit = o.implicit;
  if (implicit.solver == "v_cycle") refuse_here("implicit.solver", implicit.solver);
  if (implicit.iterations > 0)
    refuse_here("implicit.iterations", std::to_string(implicit.iterations));
  if (implicit.newton_iterations == 1) refuse_here("implicit.newton_iterations", "1");
  if (implicit.newton_tolerance)
    refuse(o, "implicit.newton_tolerance", number(*implicit.newton_tolerance),
           "has integration.rest.tolerance");
}

void check_direct(const ImplicitOptions& o) {
  const auto refuse = [](const std::string& what, const std::string& why) {
    throw InputError("integration.implicit." + what + ", but solver direct " + why +
                     "; leave it out");
  };
  if (o.preconditioner != "auto")
    refuse("preconditioner is " + o.preconditioner, "has no iterations to precondition");
  if (o.matrix == "free") refuse("matrix is free", "factorises the assembled matrix");
  if (o.iterations > 0) refuse("iterations is " + std::to_string(o.iterations), "does not iterate");
}

void check_v_cycle(const ImplicitOptions& o) {
  const auto refuse = [](const std::string& what, const std::string& why) {
    throw InputError("integration.implicit." + what + ", but solver v_cycle " + why +
                     "; leave it out");
  };
  if (o.preconditioner != "auto" && o.preconditioner != "multigrid")
    refuse("preconditioner is " + o.preconditioner, "is a cycle of multigrid");
  if (o.matrix == "assembled")
    refuse("matrix is assembled", "needs one only where its cycle is fitted");
  if (o.iterations > 0) refuse("iterations is " + std::to_string(o.iterations), "does not iterate");
}

void check_implicit(const ImplicitOptions& o) {
  if (o.solver == "direct") check_direct(o);
  if (o.solver == "v_cycle") check_v_cycle(o);
}

}  // namespace

/// Damping by stiffness is no force that an inertia answers. An inertia does not know the stiffness
/// of an enclosed fluid, nor which directions hold a vertex.
std::string refused_by_him(const Problem& problem) {
  if (damps_by_stiffness(problem.body))
    return "body.damping.stiffness is above 0, but cycle him is stable for forces without it only; "
           "use body.damping.mass or another cycle";
  const auto& fixed = problem.body.fixed;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i].in_part())
      return "integration.cycle is him, but body.fixed." + std::to_string(i) +
             " holds vertices along some directions alone, which its inertia does not know; "
             "expected cycle single or rsv, or vertices that are held along all";
  const auto& loads = problem.body.loads;
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (std::holds_alternative<EnclosedVolume>(loads[i].load))
      return "integration.cycle is him, but body.loads." + std::to_string(i) +
             ".enclosed_volume needs cycle single, or follower_pressure instead";
  return {};
}

void validate_rest(const Problem& problem) {
  if (!seeks_rest(problem.integration)) return;
  const Body& body = problem.body;
  const InitialOptions& start = body.initial;
  const bool moves = !start.velocity.isZero(0) || !start.angular_velocity.isZero(0) ||
                     start.twist || std::ranges::any_of(start.parts, [](const PartVelocity& part) {
                       return !part.velocity.isZero(0) || !part.angular_velocity.isZero(0);
                     });
  if (moves)
    throw InputError(
        "body.initial has velocities, but integration.cycle is rest, which has no motion; expected "
        "none");
  const auto& obstacles = problem.contact.obstacles;
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    if (obstacles[i].mass)
      throw InputError(
          "contact.obstacles." + std::to_string(i) +
          ".mass: the obstacle moves by its mass, but integration.cycle is rest, which "
          "has no motion; expected an obstacle without mass, whose motion is given");
  if (body.fixed.empty() && body.prescribed.empty() && obstacles.empty())
    throw InputError(
        "integration.cycle is rest, but nothing holds the body: it may be anywhere, and a load "
        "moves it without end; expected body.fixed, body.prescribed or contact.obstacles");
}

void validate_methods(const IntegrationOptions& o, std::size_t levels) {
  check_length("integration.integrator", o.integrator.size(), levels, true);
  check_length("integration.substeps", o.substeps.size(), levels, true);
  validate_shares(o, o.cycle == "auto" ? levels : integrated_levels(o.cycle, levels));
  if (o.cycle == "fas" && o.outside != "clamp" && levels > 1)
    throw InputError("integration.outside is " + o.outside +
                     ", but cycle fas restricts masses by its weights, which "
                     "must not be negative or missing; expected clamp");
  check_him(o);
  check_auto(o);
  check_rest(o);
  check_failure(o);
  check_implicit(o.implicit);
}

}  // namespace plica
