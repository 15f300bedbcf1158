// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/choice.hpp>
#include <plica/drivers/app/output/terminal.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

std::string cycle_name(const Scene& scene, const std::optional<CycleChoice>& choice) {
  return choice ? choice->cycle : scene.problem.integration.cycle;
}

std::string choice_text(const CycleChoice& choice) {
  std::string text = "\nCycle auto\n";
  text += wrapped(fmt::format("{} at {:.3g} x the critical step; {}: {}", choice.cycle, choice.over_critical,
                              choice.error_class, choice.reason),
                  98, "  ");
  if (choice.trials.empty()) return text;
  std::vector<std::vector<std::string>> rows = {{"tried", "macro step", "of critical", "error of displacement"}};
  std::string out;
  for (const CycleTrial& trial : choice.trials) {
    rows.push_back({trial.cycle, in_units(trial.macro_step, "s"), fmt::format("{:.3g} x", trial.over_critical),
                    trial.error ? fmt::format("{:.2g} %", 100 * *trial.error) : "none"});
    if (!trial.reason.empty())
      out += wrapped(fmt::format("{} at {:.3g} x: {}", trial.cycle, trial.over_critical, trial.reason), 98, "  ");
  }
  return text + text_table(rows, "<>>>") + out +
         fmt::format("  in trials of {} against level 0 alone\n", in_units(choice.duration, "s"));
}

Json choice_json(const std::optional<CycleChoice>& choice) {
  if (!choice) return nullptr;
  Json trials = Json::array();
  for (const CycleTrial& trial : choice->trials)
    trials.push_back({{"cycle", trial.cycle},
                      {"macro_step", trial.macro_step},
                      {"over_critical", trial.over_critical},
                      {"error", trial.error ? Json(*trial.error) : Json(nullptr)},
                      {"reason", trial.reason}});
  return {{"cycle", choice->cycle},
          {"macro_step", choice->macro_step},
          {"over_critical", choice->over_critical},
          {"error_class", choice->error_class},
          {"allowed", choice->allowed},
          {"duration", choice->duration},
          {"reason", choice->reason},
          {"trials", trials}};
}

}  // namespace plica::app
