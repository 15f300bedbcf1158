// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <plica/meshes/files/reading.hpp>
#include <type_traits>

namespace plica {

namespace {

constexpr std::string_view blanks = " \t\r\v\f";

// Converts a word to a number; returns whether that succeeded. std::from_chars() does not accept a
// leading plus sign. A real number that is too large is infinite, and one too small is 0.
template <typename Number>
bool parse(std::string_view word, Number& value) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return false;
  if constexpr (std::is_floating_point_v<Number>)
    if (error == std::errc::result_out_of_range)
      return value = std::strtod(std::string(word).c_str(), nullptr), true;
  return error == std::errc();
}

}  // namespace

std::optional<double> number_in(std::string_view word) {
  double value = 0.0;
  return parse(word, value) ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> integer_in(std::string_view word) {
  std::int64_t value = 0;
  return parse(word, value) ? std::optional(value) : std::nullopt;
}

std::int64_t LineNumbers::of(std::size_t byte) {
  if (byte < at_) at_ = 0, line_ = 1;
  for (; at_ < std::min(byte, text_.size()); ++at_) line_ += text_[at_] == '\n';
  return line_;
}

std::string printable(std::string_view input) {
  const std::string quoted = shown(input);
  return quoted.substr(1, quoted.size() - 2);
}

std::string lower_case(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Some programs end a text with zero bytes, or with CP/M's end mark 0x1a
TextLines::TextLines(const FileBytes& file, char comment)
    : file_(file),
      comment_(comment),
      end_(file.bytes.find_last_not_of(std::string_view("\0\x1a", 2)) + 1) {}

TextLines::TextLines(const FileBytes& file, std::size_t begin, std::size_t end,
                     std::int64_t first_line)
    : file_(file),
      next_(begin),
      end_(end),
      next_line_(first_line),
      place_{first_line},
      part_(true) {}

void TextLines::resume_at(std::size_t byte) {
  next_ = std::min(byte, end_);
  next_line_ = 0;
}

bool TextLines::next() {
  while (next_or_blank())
    if (!words_.empty()) return true;
  return false;
}

bool TextLines::next_or_blank() {
  words_.clear();
  text_ = {};
  ended_ = next_ >= end_;
  if (ended_) return false;
  place_ = next_line_ > 0 ? Place{next_line_++, -1} : Place{0, static_cast<std::int64_t>(next_)};
  const std::string_view rest = std::string_view(file_.bytes).substr(next_, end_ - next_);
  text_ = rest.substr(0, rest.find('\n'));
  next_ = std::min(next_ + text_.size() + 1, end_);
  if (comment_ != 0) text_ = text_.substr(0, text_.find(comment_));
  split();
  return true;
}

void TextLines::split() {
  for (std::size_t at = text_.find_first_not_of(blanks); at < text_.size();) {
    const std::size_t stop = std::min(text_.find_first_of(blanks, at), text_.size());
    words_.push_back(text_.substr(at, stop - at));
    at = text_.find_first_not_of(blanks, stop);
  }
  if (words_.empty()) {
    text_ = {};
    return;
  }
  const auto first = words_.front().data() - text_.data(),
             last = words_.back().data() - text_.data();
  text_ = text_.substr(static_cast<std::size_t>(first),
                       static_cast<std::size_t>(last - first) + words_.back().size());
}

std::string_view TextLines::word(std::size_t word, std::string_view what) const {
  if (word >= words_.size())
    fail("the line ends where " + std::string(what) + " is expected: " + shown(text_));
  return words_[word];
}

double TextLines::any_number(std::size_t word, std::string_view what) const {
  const std::string_view text = this->word(word, what);
  double value = 0.0;
  if (!parse(text, value)) fail(std::string(what) + " is " + shown(text) + "; it must be a number");
  return value;
}

double TextLines::number(std::size_t word, std::string_view what) const {
  const double value = any_number(word, what);
  if (!std::isfinite(value))
    fail(std::string(what) + " is " + shown(words_[word]) + "; it must be finite");
  return value;
}

std::int64_t TextLines::integer(std::size_t word, std::string_view what) const {
  const std::string_view text = this->word(word, what);
  std::int64_t value = 0;
  if (!parse(text, value))
    fail(std::string(what) + " is " + shown(text) + "; it must be an integer below 2^63");
  return value;
}

void TextLines::expected(std::string_view what) const {
  if (ended_)
    fail("expected " + std::string(what) + (part_ ? ", but it ends here" : ", but the file ends"));
  fail("expected " + std::string(what) + ", found " + shown(text_));
}

namespace {

template <typename Visit>
auto with_type(NumberType type, const Visit& visit) {
  switch (type) {
    case NumberType::int8:
      return visit(std::int8_t{});
    case NumberType::uint8:
      return visit(std::uint8_t{});
    case NumberType::int16:
      return visit(std::int16_t{});
    case NumberType::uint16:
      return visit(std::uint16_t{});
    case NumberType::int32:
      return visit(std::int32_t{});
    case NumberType::uint32:
      return visit(std::uint32_t{});
    case NumberType::int64:
      return visit(std::int64_t{});
    case NumberType::uint64:
      return visit(std::uint64_t{});
    case NumberType::float32:
      return visit(float{});
    case NumberType::float64:
      break;
  }
  return visit(double{});
}

}  // namespace

std::size_t bytes_of(NumberType type) {
  return with_type(type, [](auto zero) { return sizeof(zero); });
}

std::int64_t Numbers::count(NumberType type, std::string_view what, NumberType each,
                            std::int64_t numbers) {
  return checked_count(integer(type, what), what, each, numbers);
}

std::int64_t Numbers::checked_count(std::int64_t count, std::string_view what, NumberType each,
                                    std::int64_t numbers) const {
  const std::int64_t most = room(each) / numbers;
  if (count < 0 || count > std::min<std::int64_t>(most, std::numeric_limits<int>::max()))
    fail(std::string(what) + " is " + std::to_string(count) + ", but there is room for " +
         std::to_string(most) + " at most");
  return count;
}

// A line with the mark '$' of a section means that the record is missing
void TextNumbers::begin(std::string_view what, std::int64_t number, std::int64_t of) {
  if (!lines_.next() || lines_.text().front() == '$')
    lines_.expected(std::string(what) +
                    (of > 0 ? " " + std::to_string(number) + " of " + std::to_string(of) : ""));
  word_ = 0;
}

void TextNumbers::end(std::string_view what) {
  if (word_ < lines_.words().size())
    lines_.fail(shown(lines_.words()[word_]) + " is too much for " + std::string(what) + ": " +
                shown(lines_.text()));
}

void TextNumbers::go_to_word(std::string_view what) {
  while (free_ && word_ >= lines_.words().size()) begin(what, 0, 0);
}

std::int64_t TextNumbers::integer(NumberType, std::string_view what) {
  go_to_word(what);
  return lines_.integer(word_++, what);
}

double TextNumbers::number(NumberType, std::string_view what) {
  go_to_word(what);
  return lines_.number(word_++, what);
}

double TextNumbers::any_number(NumberType, std::string_view what) {
  go_to_word(what);
  return lines_.any_number(word_++, what);
}

void TextNumbers::skip(std::int64_t count, NumberType, std::string_view what) {
  for (std::int64_t i = 0; i < count; ++i) {
    go_to_word(what);
    if (word_ >= lines_.words().size()) lines_.integer(word_, what);  // throws: it is missing
    ++word_;
  }
}

// Each number has at least one digit, and a blank unless it is the last one
std::int64_t TextNumbers::room(NumberType) const {
  return static_cast<std::int64_t>((lines_.bytes_left() + 1) / 2 + lines_.words().size() -
                                   std::min(word_, lines_.words().size()));
}

template <typename Number>
Number ByteNumbers::take(std::string_view what) {
  last_ = next_;
  if (left() < sizeof(Number)) fail("expected " + std::string(what) + ", but the data end");
  char bytes[sizeof(Number)];
  std::memcpy(bytes, bytes_.data() + next_, sizeof(Number));
  if (swapped_) std::reverse(bytes, bytes + sizeof(Number));
  next_ += sizeof(Number);
  Number number;
  std::memcpy(&number, bytes, sizeof(Number));
  return number;
}

std::int64_t ByteNumbers::integer(NumberType type, std::string_view what) {
  return with_type(type, [&](auto zero) -> std::int64_t {
    const auto value = take<decltype(zero)>(what);
    if constexpr (std::is_floating_point_v<decltype(zero)>)
      fail(std::string(what) + " is stored as a floating point number; it must be an integer");
    else if constexpr (std::is_same_v<decltype(zero), std::uint64_t>)
      if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
        fail(std::string(what) + " is " + std::to_string(value) +
             "; it must be an integer below 2^63");
    return static_cast<std::int64_t>(value);
  });
}

double ByteNumbers::any_number(NumberType type, std::string_view what) {
  return with_type(type,
                   [&](auto zero) { return static_cast<double>(take<decltype(zero)>(what)); });
}

double ByteNumbers::number(NumberType type, std::string_view what) {
  const double value = any_number(type, what);
  if (!std::isfinite(value))
    fail(std::string(what) + " is " + std::to_string(value) + "; it must be finite");
  return value;
}

void ByteNumbers::skip(std::int64_t count, NumberType type, std::string_view what) {
  last_ = next_;
  if (count > room(type)) fail("expected " + std::string(what) + ", but the data end");
  next_ += static_cast<std::size_t>(count) * bytes_of(type);
}

Place ByteNumbers::place() const {
  return first_.line > 0 ? first_ : Place{0, first_.byte + static_cast<std::int64_t>(last_)};
}

std::int64_t ByteNumbers::room(NumberType type) const {
  return static_cast<std::int64_t>(left() / bytes_of(type));
}

}  // namespace plica
