// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <bit>
#include <cstdint>
#include <plica/meshes/files/memory_file.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

std::string lower_case(std::string_view word);

/// Text, taken line by line as words between blanks; every complaint names the line. Knows what is
/// left of the file, so that a reader can tell an absurd count before it allocates. Where lines are
/// headings of binary data, whoever reads the data says where the lines go on; from there, lines
/// are named by their bytes.
class TextLines {
 public:
  /// All of a file but zero bytes at its end; it must outlive this. What follows `comment` on a
  /// line is left out, 0: nothing does.
  explicit TextLines(const MemoryFile& file, char comment = 0);
  /// The part of a file that begins with line `first_line` at the byte `begin` and ends before
  /// `end`.
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

  /// A word as a number; InputError with `what` it was to be, when it is missing, no number, or not
  /// finite.
  double number(std::size_t word, std::string_view what) const;  ///< finite
  /// which may be infinite or none
  double any_number(std::size_t word, std::string_view what) const;
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

/// How a binary file stores a number.
enum class NumberType {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

std::size_t bytes_of(NumberType type);
inline bool is_integer(NumberType type) { return type < NumberType::float32; }

/// Numbers one after the other, from text or from binary data: a format that has both forms is
/// parsed once. Everything is an InputError with place, `what` was to be read, and the value, when
/// it is not there or not sound.
class Numbers {
 public:
  virtual ~Numbers() = default;

  /// Record `number` of `of` begins (0 of 0: of one); the text form has each on a line of its own.
  virtual void begin(std::string_view what, std::int64_t number = 0, std::int64_t of = 0) = 0;
  /// It has been read: in the text form nothing more may be on its line.
  virtual void end(std::string_view what) = 0;

  virtual std::int64_t integer(NumberType type, std::string_view what) = 0;
  virtual double number(NumberType type, std::string_view what) = 0;  ///< finite
  /// which may be infinite or none
  virtual double any_number(NumberType type, std::string_view what) = 0;
  virtual void skip(std::int64_t count, NumberType type, std::string_view what) = 0;

  virtual Place place() const = 0;                  ///< of the last number
  virtual std::int64_t room(NumberType) const = 0;  ///< how many such numbers the rest has at most
  virtual const std::string& file() const = 0;      ///< its name
  [[noreturn]] void fail(const std::string& message) const { refuse(file(), place(), message); }

  /// How many `what` there are, each of at least `numbers` numbers of type `each`: from 0 to what
  /// the rest of the file and an int have room for, so that no absurd count is ever allocated.
  std::int64_t count(NumberType type, std::string_view what, NumberType each, std::int64_t numbers);
  /// The same of a count that has been read.
  std::int64_t checked_count(std::int64_t count, std::string_view what, NumberType each,
                             std::int64_t numbers) const;
};

/// From lines of text, whatever the type.
class TextNumbers final : public Numbers {
 public:
  /// What follows the current line. `free`: a number may be on any of the following lines, as the
  /// formats of VTK have it.
  explicit TextNumbers(TextLines& lines, bool free = false)
      : lines_(lines), free_(free), word_(lines.words().size()) {}

  /// From a word of the current line on, wherever they are.
  TextNumbers(TextLines& lines, std::size_t word) : lines_(lines), free_(true), word_(word) {}

  void begin(std::string_view what, std::int64_t number, std::int64_t of) override;
  void end(std::string_view what) override;
  std::int64_t integer(NumberType type, std::string_view what) override;
  double number(NumberType type, std::string_view what) override;
  double any_number(NumberType type, std::string_view what) override;
  void skip(std::int64_t count, NumberType type, std::string_view what) override;
  Place place() const override { return lines_.place(); }
  std::int64_t room(NumberType type) const override;
  const std::string& file() const override { return lines_.file().name; }

 private:
  void go_to_word(std::string_view what);

  TextLines& lines_;
  bool free_;
  std::size_t word_;  // of the line, the next one
};

/// From bytes, in either order of bytes.
class ByteNumbers final : public Numbers {
 public:
  /// @param bytes  of a file, or decoded from one; must outlive this
  /// @param first  the place of the first byte: a byte, or the line that all of them come from
  ByteNumbers(std::string file, std::string_view bytes, std::endian order, Place first)
      : file_(std::move(file)),
        bytes_(bytes),
        swapped_(order != std::endian::native),
        first_(first) {}

  void begin(std::string_view, std::int64_t, std::int64_t) override {}
  void end(std::string_view) override {}
  std::int64_t integer(NumberType type, std::string_view what) override;
  double number(NumberType type, std::string_view what) override;
  double any_number(NumberType type, std::string_view what) override;
  void skip(std::int64_t count, NumberType type, std::string_view what) override;
  Place place() const override;
  std::int64_t room(NumberType type) const override;
  const std::string& file() const override { return file_; }

  std::size_t taken() const { return next_; }  ///< bytes
  std::size_t left() const { return bytes_.size() - next_; }

 private:
  template <typename Number>
  Number take(std::string_view what);

  std::string file_;
  std::string_view bytes_;
  bool swapped_;
  Place first_;
  std::size_t last_ = 0, next_ = 0;
};

/// The numbers of a file whose headings are lines of text.
struct NumberForm {
  bool binary = false;
  std::endian order = std::endian::native;  ///< of bytes
  bool free = false;                        ///< as for TextNumbers

  /// What `read` makes of the numbers that follow the current line; the lines go on after them.
  template <typename Read>
  auto after(TextLines& lines, const Read& read) const {
    if (!binary) {
      TextNumbers numbers(lines, free);
      return read(numbers);
    }
    const std::size_t start = lines.next_byte();
    ByteNumbers numbers(lines.file().name, std::string_view(lines.file().bytes).substr(start),
                        order, {0, static_cast<std::int64_t>(start)});
    const auto result = read(numbers);
    lines.resume_at(start + numbers.taken());
    return result;
  }
};

}  // namespace plica
