// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/cycle_choice.hpp>
#include <plica/drivers/app/output/terminal.hpp>

namespace plica::app {
namespace {

using ChoiceJson = nlohmann::ordered_json;

ChoiceJson trial_json(const CycleTrial& trial) {
  return {{"cycle", trial.cycle},
          {"macro_step", trial.macro_step},
          {"over_critical", trial.over_critical},
          {"error", trial.error ? ChoiceJson(*trial.error) : ChoiceJson(nullptr)},
          {"reason", trial.reason},
          {"set_up_time", trial.set_up_time},
          {"step_time", trial.step_time},
          {"run_time", trial.run_time}};
}

CycleTrial trial_of(const ChoiceJson& json) {
  CycleTrial trial;
  json.at("cycle").get_to(trial.cycle);
  json.at("macro_step").get_to(trial.macro_step);
  json.at("over_critical").get_to(trial.over_critical);
  if (!json.at("error").is_null()) trial.error = json.at("error").get<double>();
  json.at("reason").get_to(trial.reason);
  json.at("set_up_time").get_to(trial.set_up_time);
  json.at("step_time").get_to(trial.step_time);
  json.at("run_time").get_to(trial.run_time);
  return trial;
}

}  // namespace

std::string choice_line(const CycleChoice& choice) {
  return fmt::format("{}{}: {}; the keys {{{}}} of integration repeat this run", choice.cycle,
                     choice.provisional ? ", provisional" : "", choice.reason, choice.keys());
}

std::string choice_text(const CycleChoice& choice) {
  std::string text = "\nCycle auto\n";
  text += wrapped(fmt::format("{} at {:.3g} x the critical step; {}: {}", choice.cycle,
                              choice.over_critical, choice.error_class, choice.reason),
                  98, "  ");
  text += wrapped(fmt::format("a scene repeats it with {}", choice.keys()), 98, "  ");
  if (choice.trials.empty()) return text;
  std::vector<std::vector<std::string>> rows = {{"tried", "macro step", "of critical",
                                                 "error of displacement", "set-up", "a step",
                                                 "the run"}};
  std::string out;
  for (const CycleTrial& trial : choice.trials) {
    rows.push_back({trial.cycle, in_units(trial.macro_step, "s"),
                    fmt::format("{:.3g} x", trial.over_critical),
                    trial.error ? fmt::format("{:.2g} %", 100 * *trial.error) : "none",
                    in_units(trial.set_up_time, "s"), in_units(trial.step_time, "s"),
                    in_units(trial.run_time, "s")});
    if (!trial.reason.empty())
      out +=
          wrapped(fmt::format("{} at {:.3g} x: {}", trial.cycle, trial.over_critical, trial.reason),
                  98, "  ");
  }
  return text + text_table(rows, "<>>>>>>") + out +
         fmt::format("  in trials of {} from {} on, which took {}\n",
                     in_units(choice.duration, "s"), in_units(choice.start, "s"),
                     in_units(choice.spent, "s"));
}

ChoiceJson choice_json(const std::optional<CycleChoice>& choice) {
  if (!choice) return nullptr;
  ChoiceJson trials = ChoiceJson::array();
  for (const CycleTrial& trial : choice->trials) trials.push_back(trial_json(trial));
  return {{"cycle", choice->cycle},
          {"macro_step", choice->macro_step},
          {"keys", choice->keys()},
          {"over_critical", choice->over_critical},
          {"error_class", choice->error_class},
          {"allowed", choice->allowed},
          {"duration", choice->duration},
          {"start", choice->start},
          {"reason", choice->reason},
          {"provisional", choice->provisional},
          {"single_time", choice->single_time},
          {"spent", choice->spent},
          {"trials", trials}};
}

std::optional<CycleChoice> choice_of(const ChoiceJson& json) {
  if (json.is_null()) return {};
  CycleChoice choice;
  json.at("cycle").get_to(choice.cycle);
  json.at("macro_step").get_to(choice.macro_step);
  json.at("over_critical").get_to(choice.over_critical);
  json.at("error_class").get_to(choice.error_class);
  json.at("allowed").get_to(choice.allowed);
  json.at("duration").get_to(choice.duration);
  json.at("start").get_to(choice.start);
  json.at("reason").get_to(choice.reason);
  json.at("provisional").get_to(choice.provisional);
  json.at("single_time").get_to(choice.single_time);
  json.at("spent").get_to(choice.spent);
  for (const ChoiceJson& trial : json.at("trials")) choice.trials.push_back(trial_of(trial));
  return choice;
}

}  // namespace plica::app
