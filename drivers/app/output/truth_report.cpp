// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/truth_report.hpp>

namespace plica::app {

const Table<Truth>& truth_columns() {
  static const Table<TruthMesh> meshes = {{"tets", &TruthMesh::tets},
                                          {"macro_step", &TruthMesh::macro_step},
                                          {"wall_time", &TruthMesh::wall_time},
                                          {"error", &TruthMesh::error}};
  static const Table<TruthFamily> family = {{"name", &TruthFamily::name},
                                            {"order", &TruthFamily::order},
                                            {"used_order", &TruthFamily::used_order},
                                            {"correction", &TruthFamily::correction},
                                            {"own_error", &TruthFamily::own_error},
                                            part("meshes", &TruthFamily::meshes, meshes)};
  static const Table<Truth> columns = {{"error", &Truth::error},
                                       {"converges", &Truth::converges},
                                       part("family", &Truth::family, family),
                                       part("check", &Truth::check, family),
                                       {"difference", &Truth::difference},
                                       {"time_error", &Truth::time_error}};
  return columns;
}

const Table<MeshReference>& mesh_columns() {
  static const Table<MeshReference> columns = {
      {"",
       [](const MeshReference& mesh) { return fmt::format("level {}", mesh.level); },
       {"error in space of"}},
      {"element", &MeshReference::element, {"elements"}},
      {"level", &MeshReference::level},
      {"own_error", &MeshReference::own_error},
      {"error_space", &MeshReference::error_space, {"error", "%"}}};
  return columns;
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
  text += mesh_columns().text(r.meshes);
  for (const TruthFamily* family : {&t.family, &t.check}) text += need_text(*family);
  return text;
}

}  // namespace plica::app
