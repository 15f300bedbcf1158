// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Place in an input file. Without a file the input came through the interface.
struct SourceLocation {
  std::string file;  ///< name as the user gave it
  int line = 0;      ///< counts from 1; 0: unknown
};

/// The one exception of set-up: bad or unsupported input. what() is "file:line: message".
class InputError : public std::runtime_error {
 public:
  /// Makes an exception of `message`, with the place before it where there is one.
  explicit InputError(const std::string& message, const SourceLocation& where = {});
};

/// Throws InputError where a saved state has another number of values of `what` than expected.
void expect_saved(std::string_view what, std::size_t values, std::size_t expected);

/// Returns the entry of `choices` with the smallest edit distance to `word`. It is empty when none
/// is near: when more than a third of the letters differ.
std::string nearest_name(std::string_view word, const std::vector<std::string>& choices);

/// Returns the sentence that every unknown name gets: "unknown KIND 'WORD'; did you mean 'NEAREST'?
/// (choices: A, B, C)".
std::string unknown_name(std::string_view kind, std::string_view word,
                         const std::vector<std::string>& choices);

}  // namespace plica
