// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>
#include <plica/core/text.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/study/stability_matrix.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <plica/kernels/materials/list.hpp>

// The stability matrix's cases, and the rules by which each must end.
namespace plica {

namespace {

using Values = std::vector<double>;
using Of = MatrixLine::Of;

/// A method and the number and length of its macro steps.
struct Method {
  std::string name;  // name of a method, see StudyCase::method
  long macro_steps = 400;
  double step = 0;  // macro step over the finest critical step; 0: auto
  enum class Kind { stepped, damped, half_damped, conserving, him, shared } kind = Kind::stepped;
};

// Returns an implicit integrator's kind. It says whether the integrator damps all motion in every
// step, only fast motion, or none.
Method::Kind kind_of(const std::string& implicit_integrator) {
  if (implicit_integrator == "implicit_euler" || implicit_integrator == "v_cycle_euler")
    return Method::Kind::damped;
  const bool half = implicit_integrator == "bdf2" || implicit_integrator == "sdirk2";
  return half ? Method::Kind::half_damped : Method::Kind::conserving;
}

template <class Visit>
void each_integrator(const Visit& visit) {
  for (const std::string& name : names(integrators()))
    Integrators::visit(name, [&](auto member) { visit(name, member); });
}

/// Returns the methods of a line. Explicit integrators that have a limit run at 0.9 of it, implicit
/// ones at ten critical steps; cycles are added.
std::vector<Method> methods(MatrixSize size, Of of, bool several_levels) {
  std::vector<Method> list;
  const bool small = size == MatrixSize::small;
  each_integrator([&](const std::string& name, auto member) {
    using Kind = decltype(member);
    if constexpr (Kind::is_explicit) {
      if (Kind::limit.radius > 0 && (of == Of::all || of == Of::explicit_alone) &&
          (!small || name == "symplectic_euler"))
        list.push_back({"single/" + name});
    } else {
      if ((of == Of::all || of == Of::implicit_alone) && !small)
        list.push_back({"single/" + name, 60, 10, kind_of(name)});
    }
  });
  if (several_levels && (of == Of::all || of == Of::him)) {
    list.push_back({"cycle/him", 100, 0, Method::Kind::him});
    if (of == Of::all && !small) {
      list.push_back({"cycle/rs/equal", 200, 1, Method::Kind::shared});
      list.push_back({"cycle/fas/equal", 200, 1, Method::Kind::shared});
    }
  }
  return list;
}

Expected completes() { return {.complete = true}; }
Expected stops(const std::string& kind = {}) { return {.stop = true, .kind = kind}; }
Expected either(const std::string& why) { return {.complete = true, .stop = true, .why = why}; }

// Strains, and speeds of impact over the wave speed, that separate the rules below
constexpr double moderate_strain = 1, large_strain = 50, gentle_impact = 0.05,
                 moderate_impact = 0.2, fast_impact = 2, hypersonic_impact = 10;

bool nodal(const MatrixBody& body) { return body.problem.body.element.front() == "nodal"; }

// Returns the outcome of one level alone with an explicit integrator. With `damps` the integrator
// damps fast motion. `linear` has one stiffness, so that its step is stable in every state. Another
// material stiffens under strain: a step below the limit at rest may then be above the limit.
Expected of_explicit(const MatrixBody& body, bool damps, bool linear, bool forbids) {
  using Start = MatrixBody::Start;
  // completes even at 200 m/s: contact is solved implicitly, which adds no energy at any speed
  if (linear) return completes();
  if (body.impact > 0)
    return damps && body.impact < fast_impact ? either(
                                                    "struck at its wave speed, its lowest layer "
                                                    "stiffens by about the margin of the step")
                                              : stops();
  if (body.start == Start::flat || (body.start == Start::thin && !forbids))
    return either(
        "its elements leave the plane in the first step; some combinations damp that before an "
        "element stiffens too "
        "far");
  if (body.start != Start::rest || body.strain() > large_strain) return stops();
  return either(
      "strained by about its own size it stiffens by about the margin of the step; when depends on "
      "both");
}

Expected through_halved_steps() {
  return {.complete = true,
          .stop = true,
          .kind = "inverted",
          .why =
              "steps are halved until elements have turned back; whether that is in time depends "
              "on the shape"};
}

// Returns the outcome of an implicit integrator. Integrators that damp all motion complete at any
// step, as long as the solver finds a state. With a material that forbids inversion it may not find
// one. Integrators that damp only fast motion gain energy from a strong recoil. Integrators that
// conserve energy do so only at constant stiffness, and at ten critical steps it changes.
Expected of_implicit(const MatrixBody& body, Method::Kind kind, bool halves, bool linear,
                     bool forbids) {
  using Start = MatrixBody::Start;
  const bool damped = kind == Method::Kind::damped, pierces = body.impact > hypersonic_impact;
  const bool conserving = kind == Method::Kind::conserving;
  if (conserving && body.impact > 0 && !pierces && (linear || body.impact <= moderate_impact))
    return either("contact begins and ends within a step; what energy that adds is not damped");
  if (linear) return pierces && !damped ? stops("contact") : completes();
  if (conserving)
    return either(
        "it conserves the energy of a linear problem; how much a changing stiffness adds depends "
        "on the shape");
  if (!damped && pierces) return stops();
  if (!damped && body.start == Start::stretched)
    return either(
        "it damps slow motion little, so the recoil may have more energy than was put in");
  if (nodal(body) && body.start == Start::stretched)
    return completes();  // tetrahedra turn inside out, the mean at a vertex does not
  const bool crushed =
      body.start != Start::rest || body.strain() > large_strain || body.impact > fast_impact;
  if (!(forbids && crushed)) return completes();
  return !halves ? stops("inverted") : body.impact > 0 ? through_halved_steps() : completes();
}

// Returns the outcome of him. Its inertia is fitted at rest and turns with the body. Where elements
// are far from their shape at rest, that rotation is not well defined. A long step takes a body
// that strikes fast through the plane in one step; then him takes shorter steps.
Expected of_him(const MatrixBody& body, const std::string& material, bool linear) {
  using Start = MatrixBody::Start;
  if (body.impact > fast_impact)
    return either("how short its steps must be after an impact depends on the material");
  const bool flat = body.start == Start::flat || body.start == Start::turned;
  if (body.start == Start::random || (flat && material == StVenantKirchhoff::name))
    return either(
        "its inertia is fitted at rest; how well it fits such a shape depends on the shape");
  if (flat || body.start == Start::mirrored) return stops();
  if (linear || body.impact > 0) return completes();
  if (nodal(body)) return stops();  // nodal elements run only with the most extreme value
  return either(
      "its inertia is fitted again where the body stiffens; whether that is in time depends on the "
      "material");
}

// Returns the outcome of rs and fas at the finest level's critical step, shared equally. Each level
// is below its limit, like an explicit level alone with twice the margin.
Expected of_shared(const MatrixBody& body, bool linear, bool forbids) {
  using Start = MatrixBody::Start;
  if (linear && body.impact > hypersonic_impact)
    return either(
        "whether a share of the step takes it through the plane depends on where it touches the "
        "plane");
  if (linear) return completes();
  if (body.impact > fast_impact) return stops();
  if (body.impact > 0)
    return either("struck at its wave speed, its lowest layer may be turned inside out");
  if (body.strain() > large_strain || body.start == Start::random) return stops();
  if (body.start == Start::flat) return completes();
  if (body.start == Start::thin) return forbids ? stops() : completes();
  return either(
      "strained by about its own size it stiffens by about the margin of the step; when depends on "
      "the mapping");
}

// Returns the outcome that a case must have, by these rules:
// * A step above the limit is refused. Where it is allowed, the run has to be stopped, since small
//   motions grow in every step.
// * Levels that lie apart are refused by every method that uses more than the finest one.
// * An element is inside out or flat from the start, and the material forbids inversion: the run is
//   stopped at once, as inverted, unless halved steps turn the element back.
// * Strains below 1 from rest: every method completes, since no material stiffens by as much as the
//   steps keep clear of their limit.
// * A body mirrored as a whole is at rest in st_venant_kirchhoff, which has no strain there: the
//   run completes.
// * Corotational elements have one stiffness except for rotations: newmark keeps their energy from
//   random starts.
// * One V-cycle gives a point only a part of the acceleration that stops it: at the highest speed
//   it passes through the plane.
// * All other cases depend on the kind of method.
Expected expected_of(const MatrixBody& body, const Method& method, const std::string& material) {
  using Start = MatrixBody::Start;
  const bool needs_levels = method.kind == Method::Kind::him || method.kind == Method::Kind::shared;
  if (body.refused || (body.apart && needs_levels)) return {.refuse = true};
  if (body.unstable) return stops();
  const bool linear = material == Linear::name, forbids = forbids_inversion(material);
  const bool implicit =
      method.kind == Method::Kind::damped || method.kind == Method::Kind::half_damped;
  // true where steps are halved that Newton's method does not solve
  const bool halves = implicit && method.name != "single/v_cycle_euler";
  if (body.inside_out() && forbids) {
    const bool turns_back = halves && body.start != Start::flat && method.name != "single/bdf2";
    if (halves && body.start == Start::random) return through_halved_steps();
    return turns_back ? completes() : stops("inverted");
  }
  if (body.start == Start::rest && body.strain() <= moderate_strain &&
      body.impact <= (method.name == "single/generalized_alpha" ? gentle_impact : moderate_impact))
    return completes();
  if (body.start == Start::mirrored && material == StVenantKirchhoff::name &&
      method.kind != Method::Kind::shared)
    return completes();
  if (body.start == Start::random && material == Corotational::name &&
      method.name == "single/newmark")
    return completes();
  if (body.impact > hypersonic_impact && method.name == "single/v_cycle_euler")
    return stops("contact");
  switch (method.kind) {
    case Method::Kind::stepped:
      return of_explicit(body, method.name == "single/rk4", linear, forbids);
    case Method::Kind::him:
      return of_him(body, material, linear);
    case Method::Kind::shared:
      return of_shared(body, linear, forbids);
    default:
      return of_implicit(body, method.kind, halves, linear, forbids);
  }
}

MatrixCase case_of(const MatrixBody& body, const Method& method, const std::string& material,
                   const std::string& name) {
  MatrixCase one{name + ", " + material + (nodal(body) ? ", nodal" : ""),
                 method.name,
                 body.problem,
                 0,
                 method.macro_steps,
                 body.displacement,
                 expected_of(body, method, material)};
  one.problem.body.material.model = material;
  const ChosenMethod chosen = chosen_method(method.name);
  one.problem = problem_of(one.problem, study_case(one.problem, {}, chosen));
  one.step = body.step > 0 ? body.step : method.step;
  one.problem.integration.allow_unstable = body.unstable || method.kind == Method::Kind::shared;
  if (!chosen.distribution.empty() || method.kind == Method::Kind::stepped)
    one.problem.integration.substeps = {1};
  return one;
}

// Returns whether nodal elements run this combination: one method of each kind, with neo_hookean,
// which forbids inversion. They run only the most extreme value of each line.
bool told_by_nodal(const std::string& material, const std::string& method) {
  return material == NeoHookean::name &&
         (method == "single/symplectic_euler" || method == "single/implicit_euler" ||
          method == "cycle/him");
}

}  // namespace

std::string Expected::text() const {
  std::string words;
  const auto add = [&](bool on, const std::string& word) {
    if (on) words += (words.empty() ? "" : " or ") + word;
  };
  add(complete, "completed"), add(stop, kind.empty() ? "stopped" : "stopped: " + kind),
      add(refuse, "refused");
  return words;
}

std::vector<MatrixCase> stability_matrix(MatrixSize size) {
  std::vector<MatrixCase> cases;
  const auto add = [&](const MatrixLine& line, double value, const std::string& element,
                       auto takes_part) {
    MatrixBody body = clamped_beam();
    body.problem.body.element = {element};
    line.set(body, value);
    body.refused = line.of == Of::explicit_alone && !body.unstable;
    body.load();
    std::string name = line.format;
    name.replace(name.find("%g"), 2, number(value));
    for (const std::string& material : materials_of_two_constants())
      for (const Method& method : methods(size, line.of, body.problem.body.levels.size() > 1))
        if (takes_part(material, method.name))
          cases.push_back(case_of(body, method, material, name));
  };
  for (const MatrixLine& line : matrix_lines()) {
    const Values values = size == MatrixSize::small ? Values{line.values.back()} : line.values;
    for (const double value : values) add(line, value, "linear", [](auto&...) { return true; });
    add(line, values.back(), "nodal", told_by_nodal);
  }
  if (size == MatrixSize::whole) std::ranges::move(tissue_cases(), std::back_inserter(cases));
  return cases;
}

}  // namespace plica
