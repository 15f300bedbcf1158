// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/study/judgement.hpp>

namespace plica {

namespace {

constexpr double resolution = 0.1;  // of an error: what the reference's own may be

bool completed(const StudyRow& row) { return row.status == "completed" && row.error && row.wall_time; }

bool dominates(const StudyRow& a, const StudyRow& b) {
  const bool as_good = *a.error <= *b.error && *a.wall_time <= *b.wall_time;
  return as_good && (*a.error < *b.error || *a.wall_time < *b.wall_time);
}

}  // namespace

void mark_pareto(std::vector<StudyRow>& rows) {
  for (StudyRow& row : rows)
    row.pareto = completed(row) && std::ranges::none_of(rows, [&](const StudyRow& other) {
                   return completed(other) && dominates(other, row);
                 });
}

bool grows(const StudyRow& row) {
  return row.spectral_radius && *row.spectral_radius > 1 + 1e-6 + row.spectral_radius_uncertainty.value_or(0);
}

std::optional<double> smallest_error(const std::vector<StudyRow>& rows) {
  std::optional<double> smallest;
  for (const StudyRow& row : rows)
    if (completed(row) && (!smallest || *row.error < *smallest)) smallest = row.error;
  return smallest;
}

bool resolves(const StudyReference& reference, double error) { return reference.own_error <= resolution * error; }

bool good_enough(const StudyResult& result) {
  const auto smallest = smallest_error(result.rows);
  return !smallest || resolves(result.reference, *smallest);
}

const StudyRow* fastest_below(const std::vector<StudyRow>& rows, double error) {
  const StudyRow* fastest = nullptr;
  for (const StudyRow& row : rows)
    if (completed(row) && *row.error < error && (fastest == nullptr || *row.wall_time < *fastest->wall_time))
      fastest = &row;
  return fastest;
}

}  // namespace plica
