// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/meshes/memory_file.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

std::string lower_case(std::string_view word);

/// Text, taken line by line as words between blanks; every complaint names the line. Knows what is left of the file, so
/// that a reader can tell an absurd count before it allocates. Where lines are headings of binary data, whoever reads
/// the data says where the lines go on; from there, lines are named by their bytes.
class TextLines {
 public:
  /// All of a file, which must outlive this. What follows `comment` on a line is left out, 0: nothing does.
  explicit TextLines(const MemoryFile& file, char comment = 0);
  /// The part of a file that begins with line `first_line` at the byte `begin` and ends before `end`.
  TextLines(const MemoryFile& file, std::size_t begin, std::size_t end, std::int64_t first_line);

  /// Goes to the next line that is not blank; false at the end of the file.
  bool next();
  /// Goes to the next line; false at the end of the file.
  bool next_or_blank();
  /// Goes on after binary data.
  void resume_at(std::size_t byte);

  std::string_view text() const { return text_; }  ///< of the line, without blanks around it
  const std::vector<std::string_view>& words() const { return words_; }
  std::size_t bytes_left() const { return end_ - next_; }
  std::size_t next_byte() const { return next_; }  ///< where the next line begins
  const MemoryFile& file() const { return file_; }
  Place place() const { return place_; }

  /// A word as a number; InputError with `what` it was to be, when it is missing, no number, or not finite.
  double number(std::size_t word, std::string_view what) const;
  std::int64_t integer(std::size_t word, std::string_view what) const;

  /// InputError at this line.
  [[noreturn]] void fail(const std::string& message) const { refuse(file_.name, place_, message); }
  /// InputError "expected WHAT, found LINE"; at the end of the file "..., but the file ends".
  [[noreturn]] void expected(std::string_view what) const;

 private:
  std::string_view word(std::size_t word, std::string_view what) const;
  void split();

  const MemoryFile& file_;
  char comment_ = 0;
  std::size_t next_ = 0;  // where the line after this one starts
  std::size_t end_;
  std::int64_t next_line_ = 1;  // its number; 0: unknown
  Place place_;
  bool part_ = false, ended_ = false;
  std::string_view text_;
  std::vector<std::string_view> words_;
};

}  // namespace plica
