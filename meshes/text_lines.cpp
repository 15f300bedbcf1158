// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <plica/meshes/text_lines.hpp>

namespace plica {

namespace {

constexpr std::string_view blanks = " \t\r\v\f";

// from_chars knows no leading plus sign
template <typename Number>
bool parse(std::string_view word, Number& value) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

std::string lower_case(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

TextLines::TextLines(const MemoryFile& file, char comment) : file_(file), comment_(comment), end_(file.bytes.size()) {}

TextLines::TextLines(const MemoryFile& file, std::size_t begin, std::size_t end, std::int64_t first_line)
    : file_(file), next_(begin), end_(end), next_line_(first_line), place_{first_line}, part_(true) {}

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
  const auto first = words_.front().data() - text_.data(), last = words_.back().data() - text_.data();
  text_ = text_.substr(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first) + words_.back().size());
}

std::string_view TextLines::word(std::size_t word, std::string_view what) const {
  if (word >= words_.size()) fail("the line ends where " + std::string(what) + " is expected: " + shown(text_));
  return words_[word];
}

double TextLines::number(std::size_t word, std::string_view what) const {
  const std::string_view text = this->word(word, what);
  double value = 0.0;
  if (!parse(text, value)) fail(std::string(what) + " is " + shown(text) + "; it must be a number");
  if (!std::isfinite(value)) fail(std::string(what) + " is " + shown(text) + "; it must be finite");
  return value;
}

std::int64_t TextLines::integer(std::size_t word, std::string_view what) const {
  const std::string_view text = this->word(word, what);
  std::int64_t value = 0;
  if (!parse(text, value)) fail(std::string(what) + " is " + shown(text) + "; it must be an integer below 2^63");
  return value;
}

void TextLines::expected(std::string_view what) const {
  if (ended_) fail("expected " + std::string(what) + (part_ ? ", but it ends here" : ", but the file ends"));
  fail("expected " + std::string(what) + ", found " + shown(text_));
}

}  // namespace plica
