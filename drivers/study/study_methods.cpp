// SPDX-License-Identifier: BSD-3-Clause
// What methods there are, and which ones the options name.
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/study/study_methods.hpp>

namespace plica {

namespace {

const std::vector<std::string> families = {"single", "coarse", "cycle"};

std::string family_of(const std::string& name) { return name.substr(0, name.find('/')); }

// "cycle/rsv/equal" in two
ChosenMethod split(const std::string& name) {
  const std::size_t second = name.find('/', name.find('/') + 1);
  if (family_of(name) != "cycle" || name.find('/') == std::string::npos || second == std::string::npos)
    return {name, {}};
  return {name.substr(0, second), name.substr(second + 1)};
}

std::vector<std::string> computed_distributions() {
  std::vector<std::string> all = names(distributions());
  std::erase(all, "custom");
  return all;
}

void add(std::vector<ChosenMethod>& chosen, const ChosenMethod& one) {
  const auto same = [&](const ChosenMethod& c) { return c.method == one.method && c.distribution == one.distribution; };
  if (std::ranges::none_of(chosen, same)) chosen.push_back(one);
}

// A cycle without a distribution means each of them, with the problem's own list if it has one
void add_each(std::vector<ChosenMethod>& chosen, const Problem& problem, const ChosenMethod& one) {
  if (family_of(one.method) != "cycle" || !one.distribution.empty()) return add(chosen, one);
  for (const std::string& distribution : computed_distributions()) add(chosen, {one.method, distribution});
  if (problem.integration.distribution == "custom") add(chosen, {one.method, "custom"});
}

}  // namespace

std::vector<std::string> study_methods(const Problem& problem) {
  std::vector<std::string> methods;
  for (const std::string& integrator : names(integrators())) methods.push_back("single/" + integrator);
  for (std::size_t i = 1; i < problem.body.levels.size(); ++i) methods.push_back("coarse/" + std::to_string(i));
  for (const std::string& cycle : names(cycles()))
    if (uses_coarse_levels(cycle) && problem.body.levels.size() > 1) methods.push_back("cycle/" + cycle);
  return methods;
}

std::vector<ChosenMethod> chosen_methods(const Problem& problem, const StudyOptions& options) {
  const std::vector<std::string> all = study_methods(problem);
  std::vector<std::string> asked = options.methods;
  if (asked.empty()) asked = {"single/symplectic_euler", "single/implicit_euler", "coarse", "cycle"};
  std::vector<ChosenMethod> chosen;
  for (const std::string& name : asked) {
    const bool is_family = std::ranges::find(families, name) != families.end();
    for (const std::string& method : all)
      if (is_family && family_of(method) == name) add_each(chosen, problem, {method, {}});
    if (is_family && chosen.empty() && problem.body.levels.size() == 1)
      throw InputError("study.methods: '" + name + "' needs coarser levels; the body has one level");
    if (is_family) continue;
    const ChosenMethod one = split(name);
    if (std::ranges::find(all, one.method) == all.end()) {
      std::vector<std::string> choices = families;
      choices.insert(choices.end(), all.begin(), all.end());
      throw InputError("study.methods: " + unknown_name("method", name, choices));
    }
    const std::vector<std::string> known = names(distributions());
    if (!one.distribution.empty() && std::ranges::find(known, one.distribution) == known.end())
      throw InputError("study.methods: " + unknown_name("distribution", one.distribution, known));
    if (one.distribution == "custom" && problem.integration.distribution != "custom")
      throw InputError("study.methods: '" + name + "' needs a list of shares in integration.distribution");
    add_each(chosen, problem, one);
  }
  return chosen;
}

void check_study(const Problem& problem, const StudyOptions& options) { chosen_methods(problem, options); }

}  // namespace plica
