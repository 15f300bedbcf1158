// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Where in an input file something stands; no file: the input came through the interface. Lines
/// count from 1, 0: unknown.
struct Where {
  std::string file;  ///< as the user named it
  int line = 0;      ///< from 1
};

/// The one exception of set-up: bad or unsupported input. what() is "file:line: message".
class InputError : public std::runtime_error {
 public:
  /// `message` with the place before it, where there is one.
  explicit InputError(const std::string& message, const Where& where = {});
};

/// The entry of `choices` with the smallest edit distance to `word`; empty when none is near (more
/// than a third of the letters differ).
std::string nearest_name(std::string_view word, const std::vector<std::string>& choices);

/// "unknown KIND 'WORD'; did you mean 'NEAREST'? (choices: A, B, C)", the sentence every unknown
/// name gets.
std::string unknown_name(std::string_view kind, std::string_view word,
                         const std::vector<std::string>& choices);

}  // namespace plica
