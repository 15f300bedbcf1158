// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/truth_report.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

std::string percent(double fraction) { return fmt::format("{:.3g} %", 100 * fraction); }

namespace {

Json family_json(const TruthFamily& family) {
  Json json = {{"name", family.name},
               {"order", row_value(family.order)},
               {"used_order", family.used_order},
               {"correction", family.correction},
               {"own_error", family.own_error},
               {"meshes", Json::array()}};
  for (const TruthMesh& m : family.meshes)
    json["meshes"].push_back({{"tets", m.tets},
                              {"macro_step", m.macro_step},
                              {"wall_time", m.wall_time},
                              {"error", m.error}});
  return json;
}

TruthFamily family_of(const Json& json) {
  TruthFamily family;
  json.at("name").get_to(family.name);
  if (!json.at("order").is_null()) family.order = json.at("order").get<double>();
  json.at("used_order").get_to(family.used_order);
  json.at("correction").get_to(family.correction);
  json.at("own_error").get_to(family.own_error);
  for (const Json& m : json.at("meshes"))
    family.meshes.push_back({m.at("tets"), m.at("macro_step"), m.at("wall_time"), m.at("error")});
  return family;
}

}  // namespace

Json truth_json(const Truth& truth) {
  return {{"error", truth.error()},
          {"converges", truth.converges()},
          {"family", family_json(truth.family)},
          {"check", family_json(truth.check)},
          {"difference", truth.difference},
          {"time_error", truth.time_error}};
}

Truth truth_of(const Json& json) {
  return {family_of(json.at("family")), family_of(json.at("check")), json.at("difference"),
          json.at("time_error")};
}

Json meshes_json(const std::vector<MeshReference>& meshes) {
  Json json = Json::array();
  for (const MeshReference& m : meshes)
    json.push_back({{"element", m.element},
                    {"level", m.level},
                    {"own_error", m.own_error},
                    {"error_space", m.error_space}});
  return json;
}

std::vector<MeshReference> meshes_of(const Json& json) {
  std::vector<MeshReference> meshes;
  for (const Json& m : json)
    meshes.push_back({m.at("element"), m.at("level"), m.at("own_error"), m.at("error_space"), {}});
  return meshes;
}

std::optional<TimeForError> time_for(const TruthFamily& family, double error) {
  const auto good =
      std::ranges::find_if(family.meshes, [&](const TruthMesh& m) { return m.error <= error; });
  if (good != family.meshes.end()) return TimeForError{good->wall_time, true};
  if (family.meshes.size() < 2) return {};
  const TruthMesh &coarse = family.meshes[family.meshes.size() - 2], &fine = family.meshes.back();
  const double power =
      std::log(fine.wall_time / coarse.wall_time) / std::log(coarse.error / fine.error);
  if (!std::isfinite(power) || power <= 0) return {};
  return TimeForError{fine.wall_time * std::pow(fine.error / error, power), false};
}

namespace {

constexpr double wanted = 0.02;  // error that papers and issues call good enough for tissue

std::string quality_text(const StudyResult& result) {
  const Truth& t = *result.reference.truth;
  std::string text = fmt::format(
      " It is uncertain by {}: its own error {} ({}), the limit of {} meshes is {} away and itself "
      "good to {}, steps "
      "{}.",
      percent(t.error()), percent(t.family.own_error),
      t.converges()    ? fmt::format("order {:.2f} observed", *t.family.order)
      : t.family.order ? fmt::format("the whole correction: with an observed order of {:.2f} "
                                     "the meshes do not converge yet",
                                     *t.family.order)
                       : "the whole correction: two meshes show no order",
      t.check.name, percent(t.difference), percent(t.check.own_error), percent(t.time_error));
  if (!good_enough(result))
    text += fmt::format(
        " That is not good enough for the smallest error reported, {}: errors below {} are not to "
        "be told apart.",
        percent(*smallest_error(result.rows)), percent(10 * t.error()));
  return text;
}

std::string need_text(const TruthFamily& family) {
  const auto time = time_for(family, wanted);
  const std::string head =
      fmt::format("Explicit alone, {} meshes: {} of error ", family.name, percent(wanted));
  if (!time) return head + "is not in sight: the finer of them are no better.\n";
  return head + fmt::format("{} {}{}.\n", time->measured ? "took" : "would take about",
                            in_units(time->seconds, "s"),
                            time->measured ? "" : ", extrapolated from the two finest");
}

}  // namespace

std::string truth_text(const StudyResult& result) {
  const StudyReference& r = result.reference;
  const Truth& t = *r.truth;
  std::string tets;
  for (const TruthMesh& m : t.family.meshes)
    tets += fmt::format("{}{}", tets.empty() ? "" : ", ", m.tets);
  std::string text = wrapped(
      fmt::format(
          "Reference: the truth, Richardson's limit of {} meshes of {} tetrahedra; {} to find.",
          t.family.name, tets, in_units(r.wall_time, "s")) +
          quality_text(result),
      text_width, "");
  std::vector<std::vector<std::string>> table = {{"error in space of", "elements", "error"}};
  for (const MeshReference& m : r.meshes)
    table.push_back({fmt::format("level {}", m.level), m.element, percent(m.error_space)});
  text += text_table(table, "<<>");
  for (const TruthFamily* family : {&t.family, &t.check}) text += need_text(*family);
  return text;
}

}  // namespace plica::app
