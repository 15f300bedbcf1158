// SPDX-License-Identifier: BSD-3-Clause
// The table of stiff and extreme cases, and the rules by which each must end.
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/integrators/list.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/study/matrix_bodies.hpp>
#include <plica/drivers/study/stability_matrix.hpp>
#include <plica/drivers/study/study_methods.hpp>

namespace plica {

namespace {

using Values = std::vector<double>;

/// Which methods a line is run with.
enum class Of { all, implicit_alone, him, explicit_alone };

/// A line of the matrix: one thing that varies.
struct Line {
  const char* format;  // of the value
  Values values;       // the most extreme last
  void (*set)(MatrixBody&, double);
  Of of = Of::all;
};

const Line lines[] = {
    {"E = %g Pa", {1e2, 1e4, 1e6, 1e8, 1e10}, set_young_modulus},
    {"E = %g Pa on Earth", {1e10, 1e8, 1e6, 1e4, 1e2}, set_young_modulus_on_earth},
    {"nu = %g", {0, 0.3, 0.45, 0.49, 0.499}, set_poisson_ratio},
    {"density %g kg/m^3", {2e4, 1e3, 1}, set_density},
    {"length %g m", {1, 1e-2, 1e3, 1e-4}, set_size},
    {"%g x gravity", {1, 10, 100, 1000}, set_gravity},
    {"%g x critical", {0.1, 1, 10, 100, 1000}, set_step, Of::implicit_alone},
    {"%g x critical", {1, 2, 4, 8, 16, 32, 64}, set_step, Of::him},
    {"%g x critical, refused", {1.01, 2, 100}, set_step, Of::explicit_alone},
    {"%g x critical, allowed", {1.05, 2, 10}, set_unstable_step, Of::explicit_alone},
    {"slivers 1 : %g", {10, 100, 1000}, set_slivers},
    {"stretched x %g", {2, 5}, set_stretch},
    {"flattened to %g", {0.01, 0}, set_thickness},
    {"turned inside out x %g", {-0.5, -1}, set_thickness},
    {"vertices at random, seed %g", {1, 2}, set_random},
    {"impact at %g m/s", {0.1, 1, 10, 50, 200}, set_impact},
    {"stiffness 1 : %g", {1e2, 1e4, 1e6}, set_contrast},
    {"one tetrahedron, edge %g m", {1e-3, 1}, set_one_tetrahedron},
    {"%g levels", {1, 2, 3, 4, 5, 6}, set_levels},
    {"levels %g lengths apart", {0.5, 0.9, 0.99}, set_overlap},
};

/// How a method is run here: so many macro steps, of so many critical steps where that is not its own choice.
struct Method {
  std::string name;  // as of a study
  long macro_steps = 400;
  double step = 0;           // times the finest critical step; 0: auto
  bool keeps_linear = true;  // bounded about rest by theory, at that step
};

template <class Visit>
void each_integrator(const Visit& visit) {
  for (const std::string& name : names(integrators()))
    Integrators::visit(name, [&](auto member) { visit(name, member); });
}

/// Explicit ones at 0.9 of their limit, where they have one; implicit ones at ten times it; cycles.
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
      if ((of == Of::all || of == Of::implicit_alone) && !small) list.push_back({"single/" + name, 60, 10});
    }
  });
  if (several_levels && (of == Of::all || of == Of::him)) {
    list.push_back({"cycle/him", 100});
    if (of == Of::all && !small) {
      list.push_back({"cycle/rs/equal", 200, 1, false});
      list.push_back({"cycle/fas/equal", 200, 1, false});
    }
  }
  return list;
}

// What must become of it, and why:
// * a step above the limit is refused; where it is allowed, the run has to be stopped, since small motions grow in every step;
// * an element that is inside out or flat from the start, where the material has no answer to that: stopped at once, as inverted;
// * `linear`, whose stiffness is the same in every state, and strains of a per cent, at which no material is stiffer by as much
//   as the steps keep clear of their limit: methods that are stable about rest come to the end. Of him only the latter: its
//   inertia turns with the body, and does not know which way where elements are far from their shape;
// * what strikes faster than its own waves may be stopped as lost to contact;
// * anything else may stiffen, invert or, by a cycle that lets small motions grow, blow up: it comes to its end or is stopped;
// * him may say beforehand that it has no inertia for a step, or for contact; cycles, that levels hardly meet.
Expected expected_of(const MatrixBody& body, const Method& method, const std::string& material) {
  Expected e;
  e.refuse = body.refused;
  e.stop = body.unstable;
  if (e.refuse || e.stop) return e;
  if (body.inside_out && forbids_inversion(material)) return {.stop = true, .kind = "inverted"};
  const bool him = method.name == "cycle/him", single = method.name.starts_with("single/");
  const bool calm = (material == "linear" && !him) || (body.gentle && !body.inside_out);
  e.complete = true;
  e.stop = !(calm && method.keeps_linear) || body.pierces;
  e.refuse = (him && body.may_lack_inertia) || (!single && body.barely_overlaps);
  return e;
}

MatrixCase case_of(const MatrixBody& body, const Method& method, const std::string& material, const std::string& name) {
  MatrixCase one{name + ", " + material,
                 method.name,
                 body.problem,
                 0,
                 method.macro_steps,
                 body.displacement,
                 expected_of(body, method, material)};
  one.problem.body.material.model = material;
  const std::size_t first = method.name.find('/'), second = method.name.find('/', first + 1);
  const bool shares = second != std::string::npos;
  const StudyCase study =
      study_case(one.problem, {}, {method.name.substr(0, second), shares ? method.name.substr(second + 1) : "", ""});
  one.problem = problem_of(one.problem, study);
  one.step = body.step > 0 ? body.step : method.step;
  one.problem.integration.allow_unstable = body.unstable || !method.keeps_linear;
  if (shares) one.problem.integration.substeps = {1};
  return one;
}

}  // namespace

std::string Expected::text() const {
  std::string words;
  const auto add = [&](bool on, const std::string& word) {
    if (on) words += (words.empty() ? "" : " or ") + word;
  };
  add(complete, "completed"), add(stop, kind.empty() ? "stopped" : "stopped: " + kind), add(refuse, "refused");
  return words;
}

std::vector<MatrixCase> stability_matrix(MatrixSize size) {
  std::vector<MatrixCase> cases;
  for (const Line& line : lines) {
    Values values = line.values;
    if (size == MatrixSize::small) values = {values.back()};
    for (const double value : values) {
      MatrixBody body = clamped_beam();
      line.set(body, value);
      body.refused = line.of == Of::explicit_alone && !body.unstable;
      body.may_lack_inertia = body.may_lack_inertia || line.of == Of::him;
      body.load();
      std::string name = line.format;
      name.replace(name.find("%g"), 2, number(value));
      for (const std::string& material : names(materials()))
        for (const Method& method : methods(size, line.of, body.problem.body.levels.size() > 1))
          cases.push_back(case_of(body, method, material, name));
    }
  }
  return cases;
}

}  // namespace plica
