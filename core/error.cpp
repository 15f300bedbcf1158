// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/core/error.hpp>
#include <utility>

namespace plica {

namespace {

std::string placed(const std::string& message, const Where& where) {
  if (where.file.empty()) return message;
  return where.file + (where.line > 0 ? ":" + std::to_string(where.line) : "") + ": " + message;
}

// Levenshtein's distance, one row of the table at a time
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i] != b[j] ? 1 : 0);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substitute});
    }
  }
  return row.back();
}

}  // namespace

InputError::InputError(const std::string& message, const Where& where) : std::runtime_error(placed(message, where)) {}

std::string nearest_name(std::string_view word, const std::vector<std::string>& choices) {
  std::string best;
  std::size_t distance = std::max<std::size_t>(2, (word.size() + 2) / 3) + 1;
  for (const std::string& choice : choices) {
    const std::size_t d = edit_distance(word, choice);
    if (d < distance) distance = d, best = choice;
  }
  return best;
}

std::string unknown_name(std::string_view kind, std::string_view word, const std::vector<std::string>& choices) {
  std::string text = "unknown " + std::string(kind) + " '" + std::string(word) + "'";
  if (const std::string near = nearest_name(word, choices); !near.empty()) text += "; did you mean '" + near + "'?";
  text += " (choices:";
  for (std::size_t i = 0; i < choices.size(); ++i) text += (i > 0 ? ", " : " ") + choices[i];
  return text + ")";
}

}  // namespace plica
