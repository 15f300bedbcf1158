// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/set_up/distributions.hpp>
#include <plica/drivers/solver/set_up/plan_steps.hpp>

namespace plica {

namespace {

constexpr double auto_safety = 0.9;  // of the predicted limit, for `macro_step: auto`

template <class T>
const T& of_level(const std::vector<T>& values, std::size_t i) {
  return values.size() == 1 ? values.front() : values[i];
}

/// The largest macro step at which every explicit level keeps its limit; `auto` counts as one sub-step.
double largest_macro_step(const IntegrationOptions& o, const std::vector<LevelLimits>& levels,
                          const std::vector<double>& share) {
  double largest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (levels[i].is_explicit && share[i] > 0)
      largest = std::min(largest, levels[i].critical_step * std::max(1, of_level(o.substeps, i)) / share[i]);
  return largest;
}

double automatic_macro_step(const IntegrationOptions& o, const std::vector<LevelLimits>& levels,
                            const std::vector<double>& share) {
  const double largest = largest_macro_step(o, levels, share);
  if (!std::isfinite(largest))
    throw InputError(
        "integration.macro_step is auto, but no level has a stability limit to derive it from (implicit, or nothing "
        "moves);"
        " give it in seconds");
  if (!(largest > 0))
    throw InputError(
        "integration.macro_step is auto, but an integrator of its levels is stable at no step here (undamped, euler "
        "and rk2"
        " grow at every step); use symplectic_euler, or damp the body (body.damping.mass)");
  return auto_safety * largest;
}

int automatic_substeps(const IntegrationOptions& o, const LevelLimits& level, double span) {
  if (!level.is_explicit || !(level.critical_step > 0)) return 1;
  const double needed = std::ceil(span / (o.safety * level.critical_step) * (1 - 1e-9));
  if (needed > 1e6)
    throw InputError("integration.macro_step asks for " + std::to_string(needed) +
                     " sub-steps on one level; expected at most 1000000");
  return std::max(1, static_cast<int>(needed));
}

void refuse_unstable(const LevelLimits& level, std::size_t i, double span, int substeps) {
  char text[400];
  if (!(level.critical_step > 0)) {
    std::snprintf(text, sizeof text,
                  "level %zu: integrator '%s' is stable at no step here: undamped it grows at every step; use"
                  " symplectic_euler, damp the body (body.damping.mass), or set integration.allow_unstable: true",
                  i, level.integrator.c_str());
    throw InputError(text);
  }
  const double step = span / substeps;
  if (step <= level.critical_step * (1 + 1e-9)) return;
  std::snprintf(
      text, sizeof text,
      "level %zu: the %s sub-step %.4g s is %.3g times its critical step %.4g s; use a macro_step %.3g times smaller,"
      " substeps: %d or auto, an implicit integrator, or set integration.allow_unstable: true",
      i, level.integrator.c_str(), step, step / level.critical_step, level.critical_step, step / level.critical_step,
      static_cast<int>(std::ceil(span / level.critical_step)));
  std::optional<StiffElement> named;
  if (level.stiffest.step < named_below * level.typical_element) named = level.stiffest;
  throw SubstepRefused(text, static_cast<int>(i), named);
}

std::string with_element(const std::string& words, const std::optional<StiffElement>& e) {
  if (!e) return words;
  char text[200];
  std::snprintf(text, sizeof text, "; its element %d", e->element);
  std::string all = words + text;
  if (!e->region.empty()) all += " (region " + e->region + ")";
  std::snprintf(text, sizeof text,
                ", longest edge over smallest height %.3g, allows no more than about %.3g s by itself", e->height_ratio,
                e->step);
  return all + text;
}

}  // namespace

SubstepRefused::SubstepRefused(const std::string& without, int of, const std::optional<StiffElement>& one)
    : InputError(with_element(without, one)), words(without), level(of), element(one) {}

StepPlan plan_steps(const IntegrationOptions& o, const std::vector<LevelLimits>& levels) {
  LevelFacts facts;
  for (const LevelLimits& level : levels) {
    facts.tets.push_back(level.tets);
    facts.critical_step.push_back(level.critical_step);
  }
  StepPlan plan;
  plan.share = make_shares(o, facts);
  plan.macro_step = o.macro_step ? *o.macro_step : automatic_macro_step(o, levels, plan.share);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double span = plan.share[i] * plan.macro_step;
    const int asked = of_level(o.substeps, i);
    plan.substeps.push_back(asked > 0 ? asked : automatic_substeps(o, levels[i], span));
    if (levels[i].is_explicit && !o.allow_unstable) refuse_unstable(levels[i], i, span, plan.substeps.back());
  }
  return plan;
}

}  // namespace plica
