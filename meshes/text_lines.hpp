// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <filesystem>
#include <plica/core/error.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// A text file, taken line by line as words between blanks; every complaint names the line. Knows what is left of the
/// file, so that a reader can tell an absurd count before it allocates.
class TextLines {
 public:
  /// Reads the whole file; InputError when there is none, or a folder.
  explicit TextLines(const std::filesystem::path& path);

  /// Goes to the next line that is not blank; false at the end of the file.
  bool next();

  std::string_view text() const { return text_; }  ///< of the line, without blanks around it
  const std::vector<std::string_view>& words() const { return words_; }
  std::size_t bytes_left() const { return content_.size() - next_; }
  Where where() const { return {file_, line_}; }
  int line() const { return line_; }

  /// A word as a number; InputError with `what` it was to be, when it is missing, no number, or not finite.
  double number(std::size_t word, std::string_view what) const;
  std::int64_t integer(std::size_t word, std::string_view what) const;

  /// InputError at this line.
  [[noreturn]] void fail(const std::string& message) const;
  /// InputError "expected WHAT, found LINE"; at the end of the file "..., but the file ends".
  [[noreturn]] void expected(std::string_view what) const;

 private:
  std::string_view word(std::size_t word, std::string_view what) const;

  std::string file_;
  std::string content_;
  std::size_t next_ = 0;  // where the line after this one starts
  int line_ = 0;
  bool ended_ = false;
  std::string_view text_;
  std::vector<std::string_view> words_;
};

/// Input as an error shows it: in quotes, without control characters, cut when it is long.
std::string shown(std::string_view input);

}  // namespace plica
