// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <bit>
#include <cstdint>
#include <plica/meshes/text_lines.hpp>
#include <string>
#include <string_view>

namespace plica {

/// How a binary file stores a number.
enum class NumberType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::size_t bytes_of(NumberType type);
inline bool is_integer(NumberType type) { return type < NumberType::float32; }

/// Numbers one after the other, from text or from binary data: a format that has both forms is parsed once.
/// Everything is an InputError with place, `what` was to be read, and the value, when it is not there or not sound.
class Numbers {
 public:
  virtual ~Numbers() = default;

  /// Record `number` of `of` begins (0 of 0: of one); the text form has each on a line of its own.
  virtual void begin(std::string_view what, std::int64_t number = 0, std::int64_t of = 0) = 0;
  /// It has been read: in the text form nothing more may be on its line.
  virtual void end(std::string_view what) = 0;

  virtual std::int64_t integer(NumberType type, std::string_view what) = 0;
  virtual double number(NumberType type, std::string_view what) = 0;  ///< finite
  virtual void skip(std::int64_t count, NumberType type, std::string_view what) = 0;

  virtual Place place() const = 0;                  ///< of the last number
  virtual std::int64_t room(NumberType) const = 0;  ///< how many such numbers the rest has at most
  virtual const std::string& file() const = 0;      ///< its name
  [[noreturn]] void fail(const std::string& message) const { refuse(file(), place(), message); }

  /// How many `what` there are, each of at least `numbers` numbers of type `each`: from 0 to what the rest of the file
  /// and an int have room for, so that no absurd count is ever allocated.
  std::int64_t count(NumberType type, std::string_view what, NumberType each, std::int64_t numbers);
  /// The same of a count that has been read.
  std::int64_t checked_count(std::int64_t count, std::string_view what, NumberType each, std::int64_t numbers) const;
};

/// From lines of text, whatever the type.
class TextNumbers final : public Numbers {
 public:
  /// What follows the current line. `free`: a number may be on any of the following lines, as the formats of VTK have it.
  explicit TextNumbers(TextLines& lines, bool free = false) : lines_(lines), free_(free), word_(lines.words().size()) {}

  void begin(std::string_view what, std::int64_t number, std::int64_t of) override;
  void end(std::string_view what) override;
  std::int64_t integer(NumberType type, std::string_view what) override;
  double number(NumberType type, std::string_view what) override;
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
      : file_(std::move(file)), bytes_(bytes), swapped_(order != std::endian::native), first_(first) {}

  void begin(std::string_view, std::int64_t, std::int64_t) override {}
  void end(std::string_view) override {}
  std::int64_t integer(NumberType type, std::string_view what) override;
  double number(NumberType type, std::string_view what) override;
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
    ByteNumbers numbers(lines.file().name, std::string_view(lines.file().bytes).substr(start), order,
                        {0, static_cast<std::int64_t>(start)});
    const auto result = read(numbers);
    lines.resume_at(start + numbers.taken());
    return result;
  }
};

}  // namespace plica
