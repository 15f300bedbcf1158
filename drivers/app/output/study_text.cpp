// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <plica/drivers/app/output/study_text.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/study/judgement.hpp>

namespace plica::app {
namespace {

constexpr double thresholds[] = {0.05, 0.01, 0.001};
constexpr std::size_t width = 110;

std::string percent(double fraction) { return fmt::format("{:.3g} %", 100 * fraction); }

// With what tells it from other rows of its name
std::string name_of(const StudyRow& row, const StudyResult& result) {
  const auto differs = [&](auto member) {
    return std::ranges::any_of(result.rows, [&](const StudyRow& other) { return other.*member != row.*member; });
  };
  std::string name = row.label();
  if (differs(&StudyRow::precision)) name += ", " + row.precision;
  if (differs(&StudyRow::threads)) name += ", " + counted(row.threads, "thread");
  return name;
}

std::string reference_text(const StudyResult& result) {
  const StudyReference& r = result.reference;
  std::string text = fmt::format("Reference: {} at {}; doubling that step moves it by {}.", r.method,
                                 in_units(r.macro_step, "s"), percent(r.own_error));
  if (!good_enough(result))
    text += fmt::format(
        " That is not good enough for the smallest error reported, {}: errors below {} are not to be told apart.",
        percent(*smallest_error(result.rows)), percent(10 * r.own_error));
  if (r.space_error)
    text += fmt::format(" A mesh twice as fine is {} away: the finest mesh's error in space.", percent(*r.space_error));
  return wrapped(text, width, "");
}

std::string growth_of(const StudyRow& row) {
  if (!row.spectral_radius) return "";
  if (!grows(row)) return "none";
  return fmt::format("{:.2g} per second", *row.growth_per_second);
}

std::string pareto_text(const StudyResult& result) {
  std::vector<const StudyRow*> front;
  for (const StudyRow& row : result.rows)
    if (row.pareto) front.push_back(&row);
  if (front.empty()) return "No method came to the end.\n";
  std::ranges::sort(front, {}, [](const StudyRow* row) { return *row->wall_time; });
  const bool growth = std::ranges::any_of(front, [](const StudyRow* row) { return row->spectral_radius.has_value(); });
  std::vector<std::vector<std::string>> table = {
      {"the best for their time", "macro step", "x critical", "error", "of velocity", "time", "work"}};
  if (growth) table[0].emplace_back("growth");
  for (const StudyRow* row : front) {
    table.push_back({name_of(*row, result), in_units(*row->macro_step, "s"),
                     fmt::format("{:.3g}", *row->macro_step_over_critical), percent(*row->error),
                     percent(*row->error_velocity), in_units(*row->wall_time, "s"), fmt::format("{:.3g}", *row->work)});
    if (growth) table.back().push_back(growth_of(*row));
  }
  return text_table(table, "<>>>>>>>");
}

// Of the linearised cycles, all rows: the amplitude's logarithm per simulated second
std::string growth_text(const StudyResult& result) {
  const StudyRow *fastest = nullptr, *stable = nullptr;
  long found = 0, growing = 0;
  for (const StudyRow& row : result.rows) {
    if (!row.spectral_radius) continue;
    ++found, growing += grows(row) ? 1 : 0;
    if (grows(row) && (fastest == nullptr || *row.growth_per_second > *fastest->growth_per_second)) fastest = &row;
    if (!grows(row) && (stable == nullptr || *row.macro_step > *stable->macro_step)) stable = &row;
  }
  if (found == 0) return {};
  const auto at = [&](const StudyRow& row) {
    return fmt::format("{} at {:.3g} x critical", name_of(row, result), *row.macro_step_over_critical);
  };
  std::string text =
      fmt::format("Small motions about rest: of {} of cycles, {} let them grow.", counted(found, "row"), growing);
  if (fastest != nullptr)
    text += fmt::format(" {} grows fastest, by {:.3g} per second.", at(*fastest), *fastest->growth_per_second);
  if (stable != nullptr) text += fmt::format(" The longest macro step without growth: {}.", at(*stable));
  return wrapped(text, width, "");
}

std::string fastest_text(const StudyResult& result, double threshold) {
  const std::string head = fmt::format("Under {:g} % error: ", 100 * threshold);
  if (!resolves(result.reference, threshold))
    return wrapped(head + fmt::format("not to be told; the reference itself is only good to {}.",
                                      percent(result.reference.own_error)),
                   width, "");
  const StudyRow* fastest = fastest_below(result.rows, threshold);
  if (fastest == nullptr) return head + "none.\n";
  std::string text =
      head + fmt::format("{} at {}, {} for {}.", name_of(*fastest, result), in_units(*fastest->macro_step, "s"),
                         in_units(*fastest->wall_time, "s"), percent(*fastest->error));
  if (fastest->method.starts_with("coarse/")) text += " A coarser mesh alone is enough here.";
  return wrapped(text, width, "");
}

std::string missing_text(const StudyResult& result) {
  const auto count = [&](const char* status) {
    return std::ranges::count_if(result.rows, [&](const StudyRow& row) { return row.status == status; });
  };
  std::string text;
  if (count("diverged") + count("refused") > 0)
    text += fmt::format("Not to the end: {} diverged, {} refused; study.json says why.\n", count("diverged"),
                        count("refused"));
  std::map<std::string, int> left_out;
  for (const LeftOut& one : result.left_out) ++left_out[one.key.substr(0, one.key.find(','))];
  std::string names;
  for (const auto& [name, runs] : left_out) names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", name, runs);
  if (!names.empty())
    text += fmt::format("Left out, {} (study.json says why):\n",
                        counted(static_cast<long>(result.left_out.size()), "run")) +
            wrapped(names, width, "  ");
  return text;
}

}  // namespace

std::string study_text(const Scene& scene, const StudyResult& result, const std::string& folder) {
  if (result.reference.trajectory.u.empty())
    return fmt::format("{}: stopped before there was a reference; nothing is written\n", scene.name);
  std::string text = fmt::format("{}: {}{}\n", scene.name, counted(static_cast<long>(result.rows.size()), "row"),
                                 result.stopped ? ", interrupted: the same command goes on with them" : "");
  text += reference_text(result) + pareto_text(result);
  for (const double threshold : thresholds) text += fastest_text(result, threshold);
  text += growth_text(result) + missing_text(result);
  return text +
         fmt::format("Files: {0}: study.json, study.csv. The picture: python3 drivers/plots/study.py {0}\n", folder);
}

}  // namespace plica::app
