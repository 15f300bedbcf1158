// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/study/verify.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {

std::vector<VerifyRow> rows_of(const VerifyProblem& problem, const VerifyContext& context) try {
  return problem.rows(context);
} catch (const std::exception& error) {
  VerifyRow row;
  row.quantity = "could not be solved", row.note = error.what(), row.judged = Judged::size;
  return {row};
}

}  // namespace

bool VerifyResult::ok() const {
  return std::ranges::none_of(rows, [](const VerifyRow& row) { return row.outcome == "not ok"; });
}

std::vector<Choice> verify_problems() {
  std::vector<Choice> choices;
  for (const VerifyProblem& problem : verify_list)
    choices.push_back({problem.name, problem.summary});
  return choices;
}

void check_problems(const std::vector<std::string>& chosen) {
  const auto known = names(verify_problems());
  for (const std::string& name : chosen)
    if (std::ranges::find(known, name) == known.end())
      throw InputError(unknown_name("problem", name, known));
}

VerifyResult verify(const VerifyOptions& options, const VerifyWatch& watch) {
  check_problems(options.problems);
  std::vector<VerifyProblem> chosen;
  for (const VerifyProblem& problem : verify_list)
    if (options.problems.empty() ||
        std::ranges::find(options.problems, problem.name) != options.problems.end())
      chosen.push_back(problem);
  VerifyResult result;
  VerifyProgress progress{"", 0, chosen.size(), &result, false};
  const auto go_on = [&](bool new_rows) {
    progress.new_rows = new_rows;
    return !watch || watch(progress);
  };
  try {
    for (const VerifyProblem& problem : chosen) {
      progress.doing = problem.name;
      auto rows = rows_of(problem, {options.small, [&] { return go_on(false); }});
      for (VerifyRow& row : rows) {
        row.problem = problem.name;
        judge(row);
        result.rows.push_back(std::move(row));
      }
      ++progress.done;
      if (!go_on(true) && progress.done < progress.of) throw VerifyStopped{};
    }
  } catch (const VerifyStopped&) {
    result.stopped = true;
  }
  return result;
}

namespace {

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

// observed order below which the values do not converge to the accepted one
constexpr double telling_order = 0.5;

/// Returns p of errors proportional to h^p, from the last two values.
std::optional<double> order_of_errors(const std::vector<VerifyValue>& v, double exact) {
  if (v.size() < 2) return {};
  const VerifyValue &coarse = v[v.size() - 2], &fine = v.back();
  return finite(std::log(std::abs((coarse.value - exact) / (fine.value - exact))) /
                std::log(coarse.size / fine.size));
}

/// Sets limit and order of a row from its last three values, at sizes in constant ratio. Leaves
/// them empty where the values do not converge. After Roache, Verification and Validation in
/// Computational Science and Engineering, 5.10.
void extrapolate(VerifyRow& row) {
  const std::size_t n = row.ours.size();
  if (n < 3) return;
  const VerifyValue* v = &row.ours[n - 3];
  const double ratio = v[1].size / v[2].size;
  if (!(ratio > 1) || !(std::abs(v[0].size / v[1].size - ratio) < 1e-9 * ratio)) return;
  const auto stiffness = [&](int i) { return std::pow(v[i].value, row.power); };
  const double change = stiffness(2) - stiffness(1),
               shrink = (stiffness(1) - stiffness(0)) / change;
  if (!(shrink > 1) || !std::isfinite(shrink)) return;
  row.order = std::log(shrink) / std::log(ratio);
  row.limit = row.power == 1 ? v[2].value + change / (shrink - 1)
                             : std::pow(stiffness(2) + change / (shrink - 1), 1 / row.power);
}

bool within(double value, const VerifyRow& row) {
  return std::abs(value - *row.accepted) <= row.tolerance * std::abs(*row.accepted);
}

bool from_above(const VerifyRow& row) {
  for (std::size_t i = 0; i < row.ours.size(); ++i)
    if (!(row.ours[i].value > *row.accepted) ||
        (i > 0 && !(row.ours[i].value < row.ours[i - 1].value)))
      return false;
  return true;
}

bool fulfilled(const VerifyRow& row) {
  const auto small = [&](const VerifyValue& v) { return std::abs(v.value) <= row.tolerance; };
  switch (row.judged) {
    case Judged::finest:
      return within(row.ours.back().value, row);
    case Judged::limit:
      return row.limit && within(*row.limit, row);
    case Judged::size:
      return std::ranges::all_of(row.ours, small);
    case Judged::order:
      return row.order && std::abs(*row.order - *row.accepted) <= row.tolerance;
    case Judged::above:
      return from_above(row);
    case Judged::nothing:
      break;
  }
  return true;
}

}  // namespace

void judge(VerifyRow& row) {
  if (row.judged == Judged::order)
    row.order = order_of_errors(row.ours, 0);
  else if (row.judged == Judged::finest && row.accepted)
    row.order = order_of_errors(row.ours, *row.accepted);
  else if (row.judged != Judged::size)
    extrapolate(row);
  if (row.judged == Judged::finest && row.order < telling_order) row.order.reset();
  const bool ok = !row.ours.empty() && fulfilled(row);
  row.outcome = !ok ? "not ok" : row.judged == Judged::nothing ? "shown" : "ok";
}

}  // namespace plica
