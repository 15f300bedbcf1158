// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/steppers.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/spaces/coarse_spaces.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <tuple>

// All methods of a study, and those that the options name.
namespace plica {

namespace {

bool has_switch(const std::string& cycle) { return stepper_needs(cycle).drift_limits; }

// Returns whether two lists are equal per level; a list of one value holds for all levels.
template <class T>
bool alike_per_level(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() == b.size()) return a == b;
  const auto& [one, each] =
      std::minmax(a, b, [](const auto& x, const auto& y) { return x.size() < y.size(); });
  return one.size() == 1 && std::ranges::all_of(each, [&](const T& x) { return x == one.front(); });
}

}  // namespace

IntegrationOptions with(IntegrationOptions options, const StudyVariant& variant) {
  const auto put = [](auto& setting, const auto& instead) {
    if (instead) setting = *instead;
  };
  put(options.shift_to_coarsest, variant.shift_to_coarsest);
  put(options.integrator, variant.integrator);
  put(options.substeps, variant.substeps);
  put(options.safety, variant.safety);
  put(options.allow_unstable, variant.allow_unstable);
  put(options.switch_threshold, variant.switch_threshold);
  put(options.outside, variant.outside);
  return options;
}

bool steps_alike(const IntegrationOptions& a, const IntegrationOptions& b) {
  const auto rest = [](const IntegrationOptions& o) {
    return std::tie(o.cycle, o.macro_step, o.distribution, o.shares, o.shift_to_coarsest, o.safety,
                    o.allow_unstable, o.outside);
  };
  return rest(a) == rest(b) && alike_per_level(a.integrator, b.integrator) &&
         alike_per_level(a.substeps, b.substeps) &&
         (a.error_class == b.error_class || a.cycle != "auto") &&
         (a.switch_threshold == b.switch_threshold || !has_switch(a.cycle));
}

std::string study_label(const std::string& method, const std::string& distribution,
                        const std::string& variant) {
  return method + (distribution.empty() ? "" : "/" + distribution) +
         (variant.empty() ? "" : "+" + variant);
}

namespace {

const std::string usual_class = "balanced";  // error class of cycle/auto in the family
const std::vector<std::string> families = {"single", "coarse", "cycle"};

std::string family_of(const std::string& name) { return name.substr(0, name.find('/')); }

}  // namespace

ChosenMethod chosen_method(const std::string& name) {
  const std::size_t plus = name.find('+');
  const std::string variant = plus == std::string::npos ? "" : name.substr(plus + 1),
                    before = name.substr(0, plus);
  const std::size_t first = before.find('/'), second = before.find('/', first + 1);
  if (family_of(before) != "cycle" || first == std::string::npos || second == std::string::npos)
    return {before, {}, variant};
  return {before.substr(0, second), before.substr(second + 1), variant};
}

namespace {

std::vector<std::string> computed_distributions() {
  std::vector<std::string> all = names(distributions());
  std::erase(all, "custom");
  return all;
}

void add(std::vector<ChosenMethod>& chosen, const ChosenMethod& one) {
  const auto same = [&](const ChosenMethod& c) {
    return c.method == one.method && c.distribution == one.distribution && c.variant == one.variant;
  };
  if (std::ranges::none_of(chosen, same)) chosen.push_back(one);
}

// Returns whether the levels of a cycle share the macro step among them
bool shares_step(const ChosenMethod& one) {
  return integrates_coarse_levels(one.method.substr(one.method.find('/') + 1));
}

bool is_chosen_by_trials(const ChosenMethod& one) { return one.method == "cycle/auto"; }

// Returns whether a method is such as coarse/1/rk4, which the family `coarse` does not include
bool names_coarse_integrator(const std::string& method) {
  return family_of(method) == "coarse" && std::ranges::count(method, '/') > 1;
}

// Adds a method; a cycle without a distribution is added with each of them. These include the
// problem's own list of shares where it has one
void add_each(std::vector<ChosenMethod>& chosen, const Problem& problem, const ChosenMethod& one) {
  if (is_chosen_by_trials(one) && one.distribution.empty()) {
    for (const std::string& error_class : names(error_classes()))
      add(chosen, {one.method, error_class, {}});
    return;
  }
  if (family_of(one.method) != "cycle" || !one.distribution.empty() || !shares_step(one))
    return add(chosen, one);
  for (const std::string& distribution : computed_distributions())
    add(chosen, {one.method, distribution, one.variant});
  if (problem.integration.distribution == "custom")
    add(chosen, {one.method, "custom", one.variant});
}

// Adds the methods of a family: `cycle` with every variant, `cycle+hybrid` with that variant only
void add_family(std::vector<ChosenMethod>& chosen, const Problem& problem,
                const StudyOptions& options, const ChosenMethod& family) {
  for (const std::string& method : study_methods(problem)) {
    if (family_of(method) != family.method || names_coarse_integrator(method)) continue;
    if (family.variant.empty() || shares_step({method, {}, {}}))
      add_each(chosen, problem,
               {method, is_chosen_by_trials({method, {}, {}}) ? usual_class : "", family.variant});
    if (family.method == "cycle" && family.variant.empty() && shares_step({method, {}, {}}))
      for (const auto& [variant, settings] : options.variants)
        add_each(chosen, problem, {method, {}, variant});
  }
  if (chosen.empty() && problem.body.levels.size() == 1)
    throw InputError("study.methods: '" + family.method +
                     "' needs coarser levels; the body has one level");
}

void check_method(const Problem& problem, const std::string& name, const ChosenMethod& one) {
  const std::vector<std::string> all = study_methods(problem),
                                 known = names(is_chosen_by_trials(one) ? error_classes()
                                                                        : distributions());
  if (std::ranges::find(all, one.method) == all.end()) {
    std::vector<std::string> choices = families;
    choices.insert(choices.end(), all.begin(), all.end());
    throw InputError("study.methods: " + unknown_name("method", one.method, choices));
  }
  if (!one.distribution.empty() && std::ranges::find(known, one.distribution) == known.end())
    throw InputError("study.methods: " +
                     unknown_name(is_chosen_by_trials(one) ? "error class" : "distribution",
                                  one.distribution, known));
  const std::string shares = is_chosen_by_trials(one) ? std::string() : one.distribution;
  if (family_of(one.method) == "cycle" && !shares_step(one) && !(shares + one.variant).empty())
    throw InputError("study.methods: '" + name + "': " + one.method +
                     " has neither shares nor variants");
  if (one.distribution == "custom" && problem.integration.distribution != "custom")
    throw InputError("study.methods: '" + name +
                     "' needs a list of shares in integration.distribution");
}

void check_variant(const StudyOptions& options, const std::string& name, const ChosenMethod& one) {
  if (name.find('+') == std::string::npos) return;
  if (family_of(one.method) != "cycle")
    throw InputError("study.methods: '" + name + "': only cycles have variants, got " + one.method);
  if (options.variants.empty())
    throw InputError("study.methods: '" + name +
                     "' needs its variant in study.variants, where there is none");
  std::vector<std::string> known;
  for (const auto& [variant, settings] : options.variants) known.push_back(variant);
  if (!options.variants.contains(one.variant))
    throw InputError("study.methods: " + unknown_name("variant", one.variant, known));
}

void check_variants(const Problem& problem, const StudyOptions& options) {
  Problem changed = problem;
  for (const auto& [name, variant] : options.variants) try {
      if (name.empty() || name.find_first_of("/+,") != std::string::npos)
        throw InputError("expected a name without / + and comma, got '" + name + "'");
      changed.integration = with(problem.integration, variant);
      validate(changed);
    } catch (const InputError& error) {
      throw InputError("study.variants." + name + ": " + error.what());
    }
}

}  // namespace

std::vector<std::string> study_methods(const Problem& problem) {
  std::vector<std::string> methods;
  for (const std::string& integrator : names(integrators()))
    methods.push_back("single/" + integrator);
  for (std::size_t i = 1; i < problem.body.levels.size(); ++i) {
    methods.push_back("coarse/" + std::to_string(i));
    for (const std::string& integrator : names(integrators()))
      if (integrator != "symplectic_euler")
        methods.push_back("coarse/" + std::to_string(i) + "/" + integrator);
  }
  for (const std::string& cycle : names(cycle_choices()))
    if (has_coarse_levels(cycle, problem.body)) methods.push_back("cycle/" + cycle);
  return methods;
}

namespace {

// Returns the default methods of a study with truth. They are each level alone by every integrator
// that is stable without damping, then the cycles
std::vector<std::string> all_alone(const Problem& problem) {
  std::vector<std::string> stable, all;
  Integrators::for_each([&](auto member) {
    using Member = decltype(member);
    const bool cycles =
        std::string(Member::name) == "v_cycle_euler" && !has_coarse_levels("auto", problem.body);
    if ((!Member::is_explicit || Member::limit.radius > 0) && !cycles)
      stable.push_back(Member::name);
  });
  for (const std::string& integrator : stable) all.push_back("single/" + integrator);
  for (std::size_t i = 1; i < problem.body.levels.size(); ++i)
    for (const std::string& integrator : stable)
      all.push_back("coarse/" + std::to_string(i) +
                    (integrator == "symplectic_euler" ? "" : "/" + integrator));
  if (has_coarse_levels("auto", problem.body)) all.push_back("cycle");
  return all;
}

}  // namespace

std::vector<ChosenMethod> chosen_methods(const Problem& problem, const StudyOptions& options) {
  std::vector<std::string> asked = options.methods;
  if (asked.empty() && options.truth) asked = all_alone(problem);
  if (asked.empty())
    asked = {"single/symplectic_euler", "single/implicit_euler", "coarse", "cycle"};
  if (options.methods.empty() && !options.truth && has_coarse_levels("auto", problem.body))
    asked.insert(asked.begin() + 2, "single/v_cycle_euler");
  std::vector<ChosenMethod> chosen;
  for (const std::string& name : asked) {
    const ChosenMethod one = chosen_method(name);
    const bool is_family = std::ranges::find(families, one.method) != families.end();
    if (!is_family) check_method(problem, name, one);
    check_variant(options, name, one);
    is_family ? add_family(chosen, problem, options, one) : add_each(chosen, problem, one);
  }
  return chosen;
}

void check_study(const Problem& problem, const StudyOptions& options) {
  if (!problem.cuts.empty())
    throw InputError(
        "cuts: a study compares states of one mesh; expected a scene without them, or plica run");
  check_variants(problem, options);
  chosen_methods(problem, options);
}

}  // namespace plica
