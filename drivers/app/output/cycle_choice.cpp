// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/cycle_choice.hpp>

namespace plica::app {
namespace {

std::string error_of_trial(const CycleTrial& trial) {
  return trial.error ? fmt::format("{:.2g} %", 100 * *trial.error) : "none";
}

const Table<CycleTrial> trial_columns = {
    {"cycle", &CycleTrial::cycle, {"tried"}},
    {"macro_step", &CycleTrial::macro_step, {"macro step", "s"}},
    {"over_critical", &CycleTrial::over_critical, {"of critical", "{:.3g} x"}},
    {"error", &CycleTrial::error},
    {"", error_of_trial, {"error of displacement", "{}"}},
    {"reason", &CycleTrial::reason},
    {"set_up_time", &CycleTrial::set_up_time, {"set-up", "s"}},
    {"step_time", &CycleTrial::step_time, {"a step", "s"}},
    {"run_time", &CycleTrial::run_time, {"the run", "s"}}};

const Table<CycleChoice> choice_columns = {{"cycle", &CycleChoice::cycle},
                                           {"macro_step", &CycleChoice::macro_step},
                                           {"keys", &CycleChoice::keys},
                                           {"over_critical", &CycleChoice::over_critical},
                                           {"error_class", &CycleChoice::error_class},
                                           {"allowed", &CycleChoice::allowed},
                                           {"duration", &CycleChoice::duration},
                                           {"start", &CycleChoice::start},
                                           {"reason", &CycleChoice::reason},
                                           {"provisional", &CycleChoice::provisional},
                                           {"single_time", &CycleChoice::single_time},
                                           {"spent", &CycleChoice::spent},
                                           part("trials", &CycleChoice::trials, trial_columns)};

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
  std::string out;
  for (const CycleTrial& trial : choice.trials)
    if (!trial.reason.empty())
      out +=
          wrapped(fmt::format("{} at {:.3g} x: {}", trial.cycle, trial.over_critical, trial.reason),
                  98, "  ");
  return text + trial_columns.text(choice.trials) + out +
         fmt::format("  in trials of {} from {} on, which took {}\n",
                     in_units(choice.duration, "s"), in_units(choice.start, "s"),
                     in_units(choice.spent, "s"));
}

nlohmann::ordered_json choice_json(const std::optional<CycleChoice>& choice) {
  return choice ? choice_columns.json(*choice) : nlohmann::ordered_json();
}

std::optional<CycleChoice> choice_of(const nlohmann::ordered_json& json) {
  if (json.is_null()) return {};
  CycleChoice choice;
  choice_columns.read(json, choice);
  return choice;
}

}  // namespace plica::app
