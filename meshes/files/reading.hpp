// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <bit>
#include <cstdint>
#include <optional>
#include <plica/meshes/files/file_bytes.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Returns the word with its letters in lower case.
std::string lower_case(std::string_view word);

/// Returns input for an error message as shown() does, without quotes.
std::string printable(std::string_view input);

/// Returns the number that a word is, which may be infinite or NaN; nothing where it is none.
std::optional<double> number_in(std::string_view word);
/// Returns the integer that a word is; nothing where it is none below 2^63.
std::optional<std::int64_t> integer_in(std::string_view word);

/// Map from bytes to lines of a text; fast for places that mostly come in ascending order.
class LineNumbers {
 public:
  explicit LineNumbers(std::string_view text) : text_(text) {}
  /// Returns the line of a byte, from 1.
  std::int64_t of(std::size_t byte);

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
};

/// Reader of text line by line, as words between blanks. Every error names the line. The number of
/// bytes left is known, so that an absurd count is refused before memory is allocated. Lines may be
/// headings of binary data: the reader of the data then sets where the lines continue, and lines
/// from there on are named by their bytes.
class TextLines {
 public:
  /// Reads a whole file, except zero bytes at its end. The file must outlive this.
  /// @param comment  starts a comment, which ends with the line; 0: there are none
  explicit TextLines(const FileBytes& file, char comment = 0);
  /// Reads the bytes [begin, end) of a file, which begin in line `first_line`.
  TextLines(const FileBytes& file, std::size_t begin, std::size_t end, std::int64_t first_line);

  /// Goes to the next line that is not blank; returns false at the end of the file.
  bool next();
  /// Goes to the next line; returns false at the end of the file.
  bool next_or_blank();
  /// Continues with a line that begins at a byte, after binary data.
  void resume_at(std::size_t byte);

  std::string_view text() const { return text_; }  ///< text of the line, without blanks around it
  const std::vector<std::string_view>& words() const { return words_; }
  std::size_t bytes_left() const { return end_ - next_; }
  std::size_t next_byte() const { return next_; }  ///< first byte of the next line
  const FileBytes& file() const { return file_; }
  Place place() const { return place_; }

  /// Returns a word as a number. Throws an InputError with the name `what` if it is missing, no
  /// number, or not finite.
  double number(std::size_t word, std::string_view what) const;
  /// Returns a word as a number, which may be infinite or NaN. Throws an InputError with the name
  /// `what` if it is missing or no number.
  double any_number(std::size_t word, std::string_view what) const;
  /// Returns a word as an integer. Throws an InputError with the name `what` if it is missing or no
  /// integer below 2^63.
  std::int64_t integer(std::size_t word, std::string_view what) const;

  /// Throws an InputError at this line.
  [[noreturn]] void fail(const std::string& message) const { refuse(file_.name, place_, message); }
  /// Throws an InputError "expected WHAT, found LINE", or "expected WHAT, but the file ends".
  [[noreturn]] void expected(std::string_view what) const;

 private:
  std::string_view word(std::size_t word, std::string_view what) const;
  void split();

  const FileBytes& file_;
  char comment_ = 0;
  std::size_t next_ = 0;  // first byte of the next line
  std::size_t end_;
  std::int64_t next_line_ = 1;  // number of the next line; 0: unknown
  Place place_;
  bool part_ = false, ended_ = false;
  std::string_view text_;
  std::vector<std::string_view> words_;
};

/// Type of a number in a binary file.
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

/// Reader of numbers one after the other, from text or binary data. A format that has both forms
/// needs one parser only. A missing or invalid value is an InputError with its place, its name
/// `what`, and the value.
class Numbers {
 public:
  virtual ~Numbers() = default;

  /// Begins record `number` of `of` (0 of 0: a single record). In text each is on a line of its
  /// own.
  virtual void begin(std::string_view what, std::int64_t number = 0, std::int64_t of = 0) = 0;
  /// Ends the record: in text nothing more may be on its line.
  virtual void end(std::string_view what) = 0;

  /// Reads an integer.
  virtual std::int64_t integer(NumberType type, std::string_view what) = 0;
  /// Reads a number, which must be finite.
  virtual double number(NumberType type, std::string_view what) = 0;
  /// Reads a number, which may be infinite or NaN.
  virtual double any_number(NumberType type, std::string_view what) = 0;
  /// Skips `count` numbers of a type.
  virtual void skip(std::int64_t count, NumberType type, std::string_view what) = 0;

  virtual Place place() const = 0;                  ///< place of the last number
  virtual std::int64_t room(NumberType) const = 0;  ///< maximum count of such numbers in the rest
  virtual const std::string& file() const = 0;      ///< name of the file
  /// Throws an InputError at the place of the last number.
  [[noreturn]] void fail(const std::string& message) const { refuse(file(), place(), message); }

  /// Reads the count of `what`, each of at least `numbers` numbers of type `each`. Throws an
  /// InputError for one below 0, or above what the rest of the file or an int has room for. An
  /// absurd count thus never leads to an allocation.
  std::int64_t count(NumberType type, std::string_view what, NumberType each, std::int64_t numbers);
  /// Returns a count of `what` that has been read, each of at least `numbers` numbers of type
  /// `each`. Throws an InputError for one below 0, or above what the rest of the file or an int has
  /// room for.
  std::int64_t checked_count(std::int64_t count, std::string_view what, NumberType each,
                             std::int64_t numbers) const;
};

/// Reader of numbers from lines of text; the type of a number has no effect.
class TextNumbers final : public Numbers {
 public:
  /// Starts after the current line.
  /// @param free  a number may be on any of the following lines, as in the formats of VTK
  explicit TextNumbers(TextLines& lines, bool free = false)
      : lines_(lines), free_(free), word_(lines.words().size()) {}

  /// Starts at a word of the current line; a number may be on any of the following lines.
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
  std::size_t word_;  // index of the next word of the line
};

/// Reader of numbers from bytes, in either byte order.
class ByteNumbers final : public Numbers {
 public:
  /// Starts at the first byte.
  /// @param bytes  bytes of a file, or decoded from one; must outlive this
  /// @param first  place of the first byte: a byte, or the line that all of them come from
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

  std::size_t taken() const { return next_; }                 ///< number of bytes that were read
  std::size_t left() const { return bytes_.size() - next_; }  ///< number of bytes that are left

 private:
  template <typename Number>
  Number take(std::string_view what);

  std::string file_;
  std::string_view bytes_;
  bool swapped_;
  Place first_;
  std::size_t last_ = 0, next_ = 0;
};

/// Form of the numbers in a file whose headings are lines of text.
struct NumberForm {
  bool binary = false;
  std::endian order = std::endian::native;  ///< byte order of binary numbers
  bool free = false;                        ///< in text a number may be on any following line

  /// Calls read(numbers) for the numbers after the current line, and returns its result. The lines
  /// continue after the numbers.
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
