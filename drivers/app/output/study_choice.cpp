// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/study_choice.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/truth_report.hpp>
#include <plica/drivers/app/scene/older_keys.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/steppers.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/meshes/files/file_bytes.hpp>
#include <sstream>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// Returns why a row is the fastest one within an allowed error
std::string reason_of(const StudyRow& row, const std::vector<StudyRow>& rows) {
  std::string text;
  if (row.total_error)
    text = fmt::format("Its mesh and elements are {} off the truth, its steps {}.",
                       percent(*row.space_error), percent(*row.error));
  long faster = 0;
  const StudyRow* best = nullptr;
  for (const StudyRow& other : rows)
    if (other.status == "completed" && *other.wall_time < *row.wall_time) {
      ++faster;
      if (best == nullptr || *other.judged() < *best->judged()) best = &other;
    }
  const std::string space = text.empty() ? "" : " ";
  if (best == nullptr) return text + space + "No row is faster.";
  return text + space +
         fmt::format("Of {} the best, {}, has {}.", counted(faster, "faster row"), best->key,
                     percent(*best->judged()));
}

// Splits "coarse/1/rk4" at the slashes
std::vector<std::string> parts_of(const std::string& method) {
  std::vector<std::string> parts;
  std::istringstream stream(method);
  for (std::string part; std::getline(stream, part, '/');) parts.push_back(part);
  return parts;
}

// Returns the settings that make a run of the scene this row; null: settings alone cannot
Json settings_of(const StudyRow& row, const std::vector<Json>& levels) {
  const std::vector<std::string> parts = parts_of(row.method);
  Json settings = Json::array();
  const auto set = [&](const std::string& key, const std::string& value) {
    settings.push_back(key + "=" + value);
  };
  if (!row.variant.empty()) return {};
  if (!row.element.empty()) set("body.element", row.element);
  const auto steps = [&](const std::string& cycle, const std::string& distribution) {
    set("integration.cycle", cycle);
    set("integration.distribution", distribution);
    set("integration.macro_step", row.automatic ? "auto" : fmt::format("{}", *row.macro_step));
  };
  const bool together = parts[0] == "cycle";
  if (together && integrates_coarse_levels(parts[1])) {
    steps(parts[1], row.distribution);
    return settings;
  }
  steps(together ? parts[1] : "single", together ? "critical" : "equal");
  if (together && !row.distribution.empty()) set("integration.error_class", row.distribution);
  set("integration.shift_to_coarsest", "0");
  set("integration.substeps", together ? "auto" : "1");
  const bool coarse = parts[0] == "coarse", named = !together && parts.size() > (coarse ? 2U : 1U);
  set("integration.integrator", named ? parts.back() : "symplectic_euler");
  if (!coarse) return settings;
  const auto level = static_cast<std::size_t>(std::stoul(parts[1]));
  if (level >= levels.size()) return {};
  set("body.levels",
      Json(std::vector<Json>(levels.begin() + static_cast<std::ptrdiff_t>(level), levels.end()))
          .dump());
  return settings;
}

}  // namespace

std::vector<StudyChoice> choices_of(const StudyResult& result) {
  std::vector<StudyChoice> choices;
  ErrorClasses::for_each([&](auto one) {
    StudyChoice choice{decltype(one)::name, decltype(one)::error, nullptr, {}};
    // the reference's own error counts, so that the row is within the class in the worst case too
    const double own = result.reference.own_error;
    choice.row = fastest_below(result.rows, choice.allowed - own);
    choice.reason = choice.row ? reason_of(*choice.row, result.rows) : "none";
    if (!choice.row && own > 0.1 * choice.allowed)
      choice.reason += ", with the " + percent(own) + " by which the reference is uncertain";
    if (!choice.row) choice.reason += ".";
    choices.push_back(choice);
  });
  return choices;
}

std::vector<Json> level_entries(const Tree& scene) {
  const Tree* body = scene.find("body");
  const Tree* levels = body ? body->find("levels") : nullptr;
  std::vector<Json> entries;
  if (levels && levels->kind == Tree::Kind::list)
    for (const Tree& level : levels->items) entries.push_back(json_of(level));
  return entries;
}

Json choices_json(const StudyResult& result, const std::vector<Json>& levels) {
  Json json = Json::array();
  for (const StudyChoice& choice : choices_of(result)) {
    const StudyRow* row = choice.row;
    json.push_back({{"error_class", choice.error_class},
                    {"allowed", choice.allowed},
                    {"case", row ? Json(row->key) : Json()},
                    {"error", row ? or_null(row->judged()) : Json()},
                    {"wall_time", row ? or_null(row->wall_time) : Json()},
                    {"settings", row ? settings_of(*row, levels) : Json()},
                    {"reason", choice.reason}});
  }
  return json;
}

std::vector<Override> settings_of_study(const std::filesystem::path& folder,
                                        const std::filesystem::path& scene,
                                        const std::vector<Override>& overrides) {
  const std::string file = (folder / "study.json").string();
  Tree tree = read_tree(scene);
  for (const Override& given : overrides) set_value(tree, given.assignment, given.label);
  const Tree* integration = tree.find("integration");
  const Tree* asked = integration ? integration->find("error_class") : nullptr;
  const std::string error_class = asked ? asked->text : IntegrationOptions().error_class;
  try {
    const Json study = Json::parse(load_file(folder / "study.json").bytes);
    const std::filesystem::path of = study.at("scene").get<std::string>();
    if (of.filename() != scene.filename())
      throw InputError("--study: it is of " + of.string() + ", expected one of " + scene.string(),
                       {file});
    for (const Json& choice : study.at("choices")) {
      if (choice.at("error_class") != error_class) continue;
      const std::string reason = choice.at("reason").get<std::string>();
      if (choice.at("settings").is_null())
        throw InputError(
            "--study: nothing to take for integration.error_class " + error_class + ": " +
                (choice.at("case").is_null()
                     ? "the study has found " + reason
                     : choice.at("case").get<std::string>() + " is not a matter of settings"),
            {file});
      message(fmt::format("{}: {}, {}. {}", error_class, choice.at("case").get<std::string>(),
                          percent(choice.at("error").get<double>()), reason));
      std::vector<Override> settings;
      for (const Json& setting : choice.at("settings"))
        settings.push_back({setting.get<std::string>(), "--study " + folder.string()});
      return settings;
    }
    std::vector<std::string> known;
    for (const Json& choice : study.at("choices")) known.push_back(choice.at("error_class"));
    throw InputError("integration.error_class: " + unknown_name("error class", error_class, known));
  } catch (const Json::exception&) {
    throw InputError("--study: expected what plica study has written", {file});
  }
}

}  // namespace plica::app
