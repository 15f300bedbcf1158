// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <iostream>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/explain.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/study_case.hpp>

namespace plica::app {
namespace {

using Json = nlohmann::ordered_json;

template <class B>
Plan plan_of(const Scene& scene, const Simulation<B>& simulation, const Machine& machine) {
  return {simulation.macro_step(),
          machine.backend,
          machine.threads,
          machine.precision,
          in_input_numbers(simulation.levels(), scene),
          simulation.him(),
          machine.choice,
          simulation.parts()};
}

// Returns what each of several ranks would have of level 0
std::vector<RankPlan> planned_ranks(const Scene& scene, int count) {
  if (const std::string why = refused_by_ranks(scene.problem); !why.empty())
    throw located(InputError(why), scene.source);
  const TetMesh& mesh = scene.problem.body.levels.front();
  return plan_ranks(mesh, element_of(scene.problem.body, 0), runs_of_patches(mesh), count);
}

void check_its_study(const Scene& scene) {
  if (scene.study.methods.empty() && scene.study.variants.empty()) return;
  try {
    check_study(scene.problem, scene.study);
  } catch (const InputError& error) {
    throw located(error, scene.source);
  }
}

std::string used_levels(const Scene& scene, std::size_t used) {
  const std::string levels = counted(static_cast<long>(used), "level"),
                    &cycle = scene.problem.integration.cycle;
  const std::size_t given = count_levels(scene.levels);
  if (cycle == "auto") return fmt::format("{} given", counted(static_cast<long>(given), "level"));
  return used < given ? fmt::format("{} (cycle '{}' uses no more of {})", levels, cycle, given)
                      : levels;
}

std::string ahead_of(const Scene& scene, const auto& simulation) {
  steps_of(scene, simulation.macro_step());  // throws for too many
  return trials_ahead(scene.problem, scene.duration, simulation.levels().front(),
                      simulation.macro_step());
}

std::string soundness_json(const Scene& scene, const auto& simulation) {
  const std::string ahead = ahead_of(scene, simulation);
  return json_text({{"scene", scene.file},
                    {"sound", true},
                    {"error", nullptr},
                    {"warnings", scene.warnings},
                    {"cycle_auto", ahead.empty() ? Json(nullptr) : Json(ahead)},
                    {"levels", levels_json(in_input_numbers(simulation.levels(), scene))}});
}

}  // namespace

std::string explained(const Scene& scene, const std::string& precision) {
  return with_set_up(scene, precision,
                     [](const Scene& of, auto& simulation, const Machine& machine) {
                       return plan_text(of, plan_of(of, simulation, machine));
                     });
}

std::string checked_json(const Scene& scene, const std::string& precision) {
  check_its_study(scene);
  return with_set_up(scene, precision,
                     [](const Scene& of, auto& simulation, const Machine&) {
                       return soundness_json(of, simulation);
                     },
                     {false, {}});
}

ExitStatus explain(const SceneArguments& arguments) {
  with_simulation(arguments,
                  [&](const Scene& scene, const auto& simulation, const Machine& machine, double) {
                    Plan plan = plan_of(scene, simulation, machine);
                    if (arguments.ranks_planned > 0)
                      plan.ranks = planned_ranks(scene, arguments.ranks_planned);
                    std::cout << (arguments.json ? plan_json(scene, plan) : plan_text(scene, plan));
                  });
  return ExitStatus::done;
}

ExitStatus check(const SceneArguments& arguments) {
  try {
    const auto say = [&](const Scene& scene, const auto& simulation, const Machine&, double) {
      check_its_study(scene);
      if (arguments.json) {
        std::cout << soundness_json(scene, simulation);
        return;
      }
      const std::string ahead = ahead_of(scene, simulation);
      std::cout << scene.file << ": sound, " << used_levels(scene, simulation.levels().size())
                << "\n"
                << (ahead.empty() ? "" : wrapped("cycle auto: " + ahead, 98, "  "));
    };
    with_simulation(arguments, say, {false, {}});
  } catch (const InputError& error) {
    if (arguments.json)
      std::cout << json_text({{"scene", arguments.scene.string()},
                              {"sound", false},
                              {"error", error.what()},
                              {"warnings", Json::array()},
                              {"levels", Json::array()}});
    throw;
  }
  return ExitStatus::done;
}

}  // namespace plica::app
