// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <plica/drivers/study/elements.hpp>
#include <plica/drivers/study/study_case.hpp>

namespace plica {

namespace {

using Step = std::optional<double>;  // none: auto

constexpr const char* coarse_integrator = "symplectic_euler";  // default of coarse/LEVEL

// macro steps over the finest critical step, the most informative first
constexpr double implicit_factors[] = {16, 4, 64};
constexpr double cycle_factors[] = {4, 1, 16, 2, 8};         // for cycles of levels
constexpr double him_factors[] = {4, 16, 32, 2, 12, 6, 20};  // for him, besides its own 8
// cost of a step of him in forces of level 0, about: 2.7 to 10 on organs
constexpr double him_step_cost = 4;
constexpr int usual_iterations = 2;  // iterations of Newton's method per stage
// iterations of conjugate gradients to 1e-6 over macro step / critical step, about. The root of the
// condition number grows with the step
constexpr double cg_iterations_per_factor = 12;

// Returns the step limit of an explicit integrator without damping; 0 where it is never stable
double limit_of(const std::string& integrator, double symplectic_limit) {
  double radius = 0;
  Integrators::visit(integrator, [&](auto member) {
    if constexpr (decltype(member)::is_explicit) radius = decltype(member)::limit.radius;
  });
  return symplectic_limit * radius / 2;
}

std::string integrator_of(const IntegrationOptions& o, std::size_t i) {
  return o.integrator.size() == 1 ? o.integrator.front() : o.integrator[i];
}

double evaluations(const StudyCase& one, const std::vector<StudyLevel>& levels, double duration) {
  const IntegrationOptions& o = one.integration;
  if (o.cycle != "single" && !integrates_coarse_levels(o.cycle)) {
    const double steps = std::ceil(duration / o.macro_step.value_or(8 * levels[0].critical_step));
    const double alone = std::ceil(duration / (o.safety * levels[0].critical_step));
    return levels[0].tets * (o.cycle == "auto" ? (1 + trial_part) * alone : him_step_cost * steps);
  }
  const bool alone = o.cycle == "single";
  std::vector<LevelLimits> limits;
  for (std::size_t i = static_cast<std::size_t>(one.level);
       i < levels.size() && (limits.empty() || !alone); ++i) {
    const std::string integrator = integrator_of(o, limits.size());
    const bool stepped = is_explicit(integrator);
    limits.push_back(
        {levels[i].tets, integrator, stepped,
         stepped ? limit_of(integrator, levels[i].critical_step) : levels[i].critical_step});
  }
  try {
    const StepPlan plan = plan_steps(o, limits);
    double each = 0;
    for (std::size_t i = 0; i < limits.size(); ++i) {
      double passes = 1;
      const double factor =
          plan.share[i] * plan.macro_step / plan.substeps[i] / limits[i].critical_step;
      if (!limits[i].is_explicit)
        passes += std::min(newton_iterations(o.implicit, limits[i].integrator),
                           o.implicit.newton_iterations > 0 ? o.implicit.newton_iterations
                                                            : usual_iterations) *
                  (o.implicit.iterations > 0 ? o.implicit.iterations
                                             : 2 + cg_iterations_per_factor * factor);
      each += passes * plan.substeps[i] * limits[i].tets;
    }
    return each * std::ceil(duration / plan.macro_step - 1e-9);
  } catch (const InputError&) {
    return 0;
  }
}

// Returns whether other cases are compared with this one
bool is_control(const StudyCase& one) {
  const std::string& integrator = one.integration.integrator.front();
  return integrator == coarse_integrator ||
         (one.level == 0 && (integrator == "implicit_euler" || integrator == "v_cycle_euler"));
}

bool is_same_run(const StudyCase& a, const StudyCase& b) {
  return a.method == b.method && a.element == b.element && a.precision == b.precision &&
         a.threads == b.threads && steps_alike(a.integration, b.integration);
}

void step_alone(IntegrationOptions& o, const std::string& integrator) {
  o.cycle = "single", o.integrator = {integrator}, o.substeps = {1}, o.shift_to_coarsest = 0;
  o.distribution = "equal", o.shares = {};
}

// Sets the options of cycle him or auto, which take no settings of levels
void step_together(IntegrationOptions& o, const std::string& cycle, const StudyCase& one) {
  const IntegrationOptions plain;
  o.cycle = cycle, o.integrator = plain.integrator, o.substeps = plain.substeps,
  o.outside = plain.outside;
  o.distribution = plain.distribution, o.shares = {}, o.shift_to_coarsest = 0;
  if (cycle == "auto") o.error_class = one.distribution, o.allow_unstable = false;
}

struct Builder {
  const Problem& problem;
  const StudyOptions& options;
  const std::vector<StudyLevel>& levels;
  std::vector<StudyCase> cases = {};

  void add_control(StudyCase one, Step macro_step, int rank) {
    one.control = true;
    add(one, macro_step, rank);
  }

  void add(StudyCase one, Step macro_step, int rank) {
    if (macro_step && *macro_step > options.duration) return;
    one.integration.macro_step = macro_step;
    const std::vector<int> threads =
        options.threads.empty() ? std::vector<int>{0} : options.threads;
    for (std::size_t p = 0; p < options.precision.size(); ++p)
      for (std::size_t t = 0; t < threads.size(); ++t) {
        one.precision = options.precision[p], one.threads = threads[t];
        one.control = one.control && p + t == 0;
        one.rank = rank + 20 * static_cast<int>(p + t);
        one.predicted_evaluations = evaluations(one, levels, options.duration);
        const auto same = [&](const StudyCase& c) {
          return c.key() == one.key() || is_same_run(c, one);
        };
        if (std::ranges::none_of(cases, same)) cases.push_back(one);
      }
  }

  void add_alone(const StudyCase& one) {
    const std::string integrator = one.integration.integrator.front();
    const bool finest = one.level == 0;
    const double critical = levels[static_cast<std::size_t>(one.level)].critical_step;
    if (!is_explicit(integrator)) {
      std::vector<double> steps;
      for (const Step& step : options.macro_steps)
        if (step) steps.push_back(*step);
      if (options.macro_steps.empty())
        for (const double factor : implicit_factors) steps.push_back(factor * critical);
      for (std::size_t i = 0; i < steps.size(); ++i)
        i == 0 && is_control(one) ? add_control(one, steps[i], 2)
                                  : add(one, steps[i], i == 0 ? 6 : 7);
      if (options.macro_steps.empty()) add_own(one);
      return;
    }
    const double limit = limit_of(integrator, critical);
    is_control(one) ? add_control(one, {}, finest ? 0 : 1) : add(one, {}, 5);
    if (finest && limit > 0) add(one, 0.5 * limit, 5);
    for (const Step& step : options.macro_steps)
      if (step && *step < limit) add(one, step, 5);
  }

  void add_him(const StudyCase& one) {
    int rank = 3;
    if (one.integration.cycle == "auto") return add(one, {}, rank);
    for (const Step& step : options.macro_steps) add(one, step, rank++);
    if (!options.macro_steps.empty()) return;
    add(one, {}, rank);
    for (const double factor : him_factors) add(one, factor * levels[0].critical_step, ++rank);
  }

  void add_cycle(const StudyCase& one) {
    if (!integrates_coarse_levels(one.integration.cycle)) return add_him(one);
    int rank = (one.distribution == "critical" ? 4 : 6) + (one.variant.empty() ? 0 : 1);
    // levels alone are run first: cycles add errors in time to the same errors in space
    if (options.truth) rank += 6;
    if (!options.macro_steps.empty()) {
      for (const Step& step : options.macro_steps) add(one, step, rank++);
      return;
    }
    add(one, {}, rank);
    add_own(one);
    for (const double factor : cycle_factors) add(one, factor * levels[0].critical_step, ++rank);
  }

  // Adds the case with the problem's own macro step
  void add_own(const StudyCase& one) {
    if (problem.integration.macro_step) add(one, problem.integration.macro_step, 5);
  }
};

}  // namespace

std::string StudyCase::label() const { return study_label(method, distribution, variant); }

std::string StudyCase::key() const {
  const std::string step = integration.macro_step ? number(*integration.macro_step) + " s" : "auto";
  return label() + ", " + step + ", " + precision + ", " +
         (threads > 0 ? std::to_string(threads) : "all") + " threads" +
         (element.empty() ? "" : ", " + element);
}

StudyLevel study_level(const Problem& problem, int level) {
  using B = Backend<double, Kokkos::DefaultExecutionSpace>;
  StudyCase alone;
  alone.level = level;
  Problem one = problem_of(problem, alone);
  one.body.loads.clear();  // a coarse mesh may lack vertices where a load acts: its run reports it
  const LevelReport report = Simulation<B>(one).levels().front();
  return {report.tets, report.critical_step};
}

std::vector<StudyLevel> study_levels(const Problem& problem) {
  std::vector<StudyLevel> levels;
  for (std::size_t i = 0; i < problem.body.levels.size(); ++i)
    levels.push_back(study_level(problem, static_cast<int>(i)));
  return levels;
}

StudyCase study_case(const Problem& problem, const StudyOptions& options,
                     const ChosenMethod& chosen) {
  StudyCase one;
  one.method = chosen.method, one.distribution = chosen.distribution, one.variant = chosen.variant;
  one.integration = problem.integration;
  IntegrationOptions& o = one.integration;
  const std::string name = chosen.method.substr(chosen.method.find('/') + 1);
  const std::size_t second = name.find('/');
  if (chosen.method.starts_with("coarse/")) {
    one.level = std::stoi(name);
    step_alone(o, second == std::string::npos ? coarse_integrator : name.substr(second + 1));
  } else if (chosen.method.starts_with("single/")) {
    step_alone(o, name);
  } else if (!integrates_coarse_levels(name)) {
    step_together(o, name, one);
  } else {
    if (!one.variant.empty()) o = with(o, options.variants.at(one.variant));
    o.cycle = name, o.distribution = one.distribution;
  }
  return one;
}

std::vector<StudyCase> study_cases(const Problem& problem, const StudyOptions& options,
                                   const std::vector<StudyLevel>& levels) {
  Builder builder{problem, options, levels};
  for (const ChosenMethod& chosen : chosen_methods(problem, options)) {
    const StudyCase one = study_case(problem, options, chosen);
    one.integration.cycle == "single" ? builder.add_alone(one) : builder.add_cycle(one);
  }
  return std::move(builder.cases);
}

Problem problem_of(const Problem& problem, const StudyCase& one) {
  Problem result = with_element(problem, one.element);
  result.integration = one.integration;
  if (one.integration.cycle != "single") return result;
  // an implicit integrator keeps the coarser levels for multigrid
  const bool alone = is_explicit(one.integration.integrator.front());
  keep_levels(result.body, static_cast<std::size_t>(one.level),
              alone ? 1 : problem.body.levels.size());
  const auto centre = [](const TetMesh& mesh) {
    const Box box = bounding_box(mesh.vertices);
    return Point((box.min + box.max) / 2);
  };
  const Point shift = centre(result.body.levels.front()) - centre(problem.body.levels.front());
  InitialOptions& initial = result.body.initial;
  if (initial.position) *initial.position += shift;
  initial.velocity += initial.angular_velocity.cross(shift);
  return result;
}

}  // namespace plica
