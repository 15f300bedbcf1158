// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/core/error.hpp>
#include <utility>

namespace plica {

namespace {

std::string placed(const std::string& message, const SourceLocation& where) {
  if (where.file.empty()) return message;
  return where.file + (where.line > 0 ? ":" + std::to_string(where.line) : "") + ": " + message;
}

// Returns Damerau's distance, in which a swap of neighbours is one edit. It needs two earlier rows
// of the table.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({last[j + 1] + 1, row[j] + 1, last[j] + (a[i] != b[j] ? 1 : 0)});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
        row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
    }
    before = std::exchange(last, row);
  }
  return last.back();
}

std::size_t difference(std::size_t a, std::size_t b) { return a > b ? a - b : b - a; }

}  // namespace

InputError::InputError(const std::string& message, const SourceLocation& where)
    : std::runtime_error(placed(message, where)) {}

std::string nearest_name(std::string_view word, const std::vector<std::string>& choices) {
  std::string best;
  std::size_t distance = std::max<std::size_t>(2, (word.size() + 2) / 3) + 1;
  for (const std::string& choice : choices) {
    const std::size_t d = edit_distance(word, choice);
    const bool nearer = d < distance || (d == distance && !best.empty() &&
                                         difference(choice.size(), word.size()) <
                                             difference(best.size(), word.size()));
    if (nearer) distance = d, best = choice;
  }
  return best;
}

void expect_saved(std::string_view what, std::size_t values, std::size_t expected) {
  if (values != expected)
    throw InputError("the saved state is damaged: it has " + std::to_string(values) +
                     " values of " + std::string(what) + "; expected " + std::to_string(expected));
}

std::string unknown_name(std::string_view kind, std::string_view word,
                         const std::vector<std::string>& choices) {
  std::string text = "unknown " + std::string(kind) + " '" + std::string(word) + "'";
  if (const std::string near = nearest_name(word, choices); !near.empty())
    text += "; did you mean '" + near + "'?";
  text += " (choices:";
  for (std::size_t i = 0; i < choices.size(); ++i) text += (i > 0 ? ", " : " ") + choices[i];
  return text + ")";
}

}  // namespace plica
