// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/methods/methods.hpp>

namespace plica {

namespace {

/// Throws InputError where weights are no proportions: 0 or not finite.
/// The critical step is 0 for undamped euler, and infinite where nothing moves.
void expect_proportions(const std::vector<double>& weights, const std::string& distribution) {
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (!(weights[i] > 0 && std::isfinite(weights[i])))
      throw InputError(text("distribution: '", distribution, "' finds no share for level ", i,
                            ", where it is ", number(weights[i]), "; use equal or custom"));
}

}  // namespace

void validate_shares(const IntegrationOptions& o, std::size_t levels) {
  if (o.distribution != "custom") return;
  check_length("integration.distribution", o.shares.size(), levels, false);
  for (const double one : o.shares) keys::Shares::share.check("integration.distribution", one);
  const double sum = std::accumulate(o.shares.begin(), o.shares.end(), 0.0);
  if (!(std::abs(sum - 1) <= 1e-12))
    throw InputError("integration.distribution: the shares must add up to 1, got " +
                     number(sum, 15));
}

std::vector<double> make_shares(const IntegrationOptions& options, const LevelFacts& facts) {
  const std::size_t levels = facts.tets.size();
  std::vector<double> w;
  if (options.distribution == "custom") {
    validate_shares(options, levels);
    w = options.shares;
  } else {
    const bool known = Distributions::visit(options.distribution,
                                            [&](auto d) { w = decltype(d)::weights(facts); });
    if (!known)
      throw InputError(unknown_name("distribution", options.distribution, names(distributions())));
    if (levels > 1) expect_proportions(w, options.distribution);
    const double sum = std::accumulate(w.begin(), w.end(), 0.0);
    for (double& share : w) share /= sum;
  }
  if (levels == 1) return {1.0};
  double moved = 0;
  for (std::size_t i = 0; i + 1 < levels; ++i) {
    moved += options.shift_to_coarsest * w[i];
    w[i] *= 1 - options.shift_to_coarsest;
  }
  w.back() += moved;
  return w;
}

namespace {

// step over the predicted limit, for `macro_step: auto`
constexpr double auto_safety = 0.9;
// step over the limit for a body that will be cut: cutting 60 % of a beam took 16 % off its limit
constexpr double auto_safety_with_cuts = 0.75;

template <class T>
const T& of_level(const std::vector<T>& values, std::size_t i) {
  return values.size() == 1 ? values.front() : values[i];
}

/// Returns the largest macro step at which every explicit level keeps its limit [s].
/// A level with `substeps: auto` counts as one sub-step.
double largest_macro_step(const IntegrationOptions& o, const std::vector<LevelLimits>& levels,
                          const std::vector<double>& share) {
  double largest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (levels[i].is_explicit && share[i] > 0)
      largest = std::min(largest,
                         levels[i].critical_step * std::max(1, of_level(o.substeps, i)) / share[i]);
  return largest;
}

double automatic_macro_step(const IntegrationOptions& o, const std::vector<LevelLimits>& levels,
                            const std::vector<double>& share, bool cuts) {
  const double largest = largest_macro_step(o, levels, share);
  if (!std::isfinite(largest)) {
    const bool none_free = std::ranges::all_of(levels, &LevelLimits::is_explicit);
    throw InputError(
        none_free ? "integration.macro_step is auto, but nothing is free to move: body.fixed and "
                    "body.prescribed hold every vertex; release some, or give the step in seconds"
                  : "integration.macro_step is auto, but no level has a stability limit to derive "
                    "it from (all are implicit); give it in seconds");
  }
  if (!(largest > 0))
    throw InputError(
        "integration.macro_step is auto, but an integrator of its levels (euler, rk2) is "
        "unconditionally unstable without damping; use symplectic_euler, or damp the body "
        "(body.damping.mass)");
  return (cuts ? auto_safety_with_cuts : auto_safety) * largest;
}

int automatic_substeps(const IntegrationOptions& o, const LevelLimits& level, double span) {
  if (!level.is_explicit || !(level.critical_step > 0)) return 1;
  const double needed = std::ceil(span / (o.safety * level.critical_step) * (1 - 1e-9));
  if (needed > 1e6)
    throw InputError(text("integration.macro_step asks for ", number(needed, 12),
                          " sub-steps on one level; expected at most 1000000"));
  return std::max(1, static_cast<int>(needed));
}

void refuse_unstable(const LevelLimits& level, std::size_t i, double span, int substeps) {
  if (!(level.critical_step > 0))
    throw InputError(text("level ", i, ": integrator '", level.integrator,
                          "' is unconditionally unstable without damping; use symplectic_euler, "
                          "damp the body (body.damping.mass), or set integration.allow_unstable: "
                          "true"));
  const double step = span / substeps;
  if (step <= level.critical_step * (1 + 1e-9)) return;
  const std::string times = number(step / level.critical_step, 3);
  const std::string words = text(
      "level ", i, ": the ", level.integrator, " sub-step ", number(step, 4), " s is ", times,
      " times its critical step ", number(level.critical_step, 4), " s; use a macro_step ", times,
      " times smaller, substeps: ", static_cast<int>(std::ceil(span / level.critical_step)),
      " or auto, an implicit integrator, or set integration.allow_unstable: true");
  std::optional<StiffElement> named;
  if (level.stiffest.step < named_below * level.typical_element) named = level.stiffest;
  throw SubstepRefused(words, static_cast<int>(i), named);
}

std::string with_element(const std::string& words, const std::optional<StiffElement>& e) {
  if (!e) return words;
  const std::string region = e->region.empty() ? "" : " (region " + e->region + ")";
  return text(words, "; its element ", e->element, region, ", longest edge over smallest height ",
              number(e->height_ratio, 3), ", allows no more than about ", number(e->step, 3),
              " s by itself");
}

}  // namespace

SubstepRefused::SubstepRefused(const std::string& without, int of,
                               const std::optional<StiffElement>& one)
    : InputError(with_element(without, one)), words(without), level(of), element(one) {}

StepPlan plan_steps(const IntegrationOptions& o, const std::vector<LevelLimits>& levels,
                    bool cuts) {
  LevelFacts facts;
  for (const LevelLimits& level : levels) {
    facts.tets.push_back(level.tets);
    facts.critical_step.push_back(level.critical_step);
  }
  StepPlan plan;
  plan.share = make_shares(o, facts);
  plan.macro_step =
      o.macro_step ? *o.macro_step : automatic_macro_step(o, levels, plan.share, cuts);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double span = plan.share[i] * plan.macro_step;
    const int asked = of_level(o.substeps, i);
    plan.substeps.push_back(asked > 0 ? asked : automatic_substeps(o, levels[i], span));
    if (levels[i].is_explicit && !o.allow_unstable)
      refuse_unstable(levels[i], i, span, plan.substeps.back());
  }
  return plan;
}

}  // namespace plica
