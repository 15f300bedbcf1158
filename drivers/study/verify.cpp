// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
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
  for (const VerifyProblem& problem : verify_list) choices.push_back({problem.name, problem.summary});
  return choices;
}

void check_problems(const std::vector<std::string>& chosen) {
  const auto known = names(verify_problems());
  for (const std::string& name : chosen)
    if (std::ranges::find(known, name) == known.end()) throw InputError(unknown_name("problem", name, known));
}

VerifyResult verify(const VerifyOptions& options, const VerifyWatch& watch) {
  check_problems(options.problems);
  std::vector<VerifyProblem> chosen;
  for (const VerifyProblem& problem : verify_list)
    if (options.problems.empty() || std::ranges::find(options.problems, problem.name) != options.problems.end())
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

}  // namespace plica
