// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
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

TextLines::TextLines(const std::filesystem::path& path) : file_(path.string()) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail("is a folder, not a file");
  std::ifstream in(path, std::ios::binary);
  if (!in) fail("cannot be opened");
  content_.assign(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) fail("cannot be read");
}

bool TextLines::next() {
  while (next_ < content_.size()) {
    const std::size_t end = std::min(content_.find('\n', next_), content_.size());
    text_ = std::string_view(content_).substr(next_, end - next_);
    next_ = std::min(end + 1, content_.size());
    ++line_;
    words_.clear();
    for (std::size_t at = text_.find_first_not_of(blanks); at < text_.size();) {
      const std::size_t stop = std::min(text_.find_first_of(blanks, at), text_.size());
      words_.push_back(text_.substr(at, stop - at));
      at = text_.find_first_not_of(blanks, stop);
    }
    if (words_.empty()) continue;
    const auto first = words_.front().data() - text_.data(), last = words_.back().data() - text_.data();
    text_ =
        text_.substr(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first) + words_.back().size());
    return true;
  }
  ended_ = true;
  text_ = {};
  words_.clear();
  return false;
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

void TextLines::fail(const std::string& message) const { throw InputError(message, where()); }

void TextLines::expected(std::string_view what) const {
  if (ended_) fail("expected " + std::string(what) + ", but the file ends");
  fail("expected " + std::string(what) + ", found " + shown(text_));
}

std::string shown(std::string_view input) {
  constexpr std::size_t longest = 60;
  std::string text = "'";
  for (const char c : input.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (input.size() > longest ? "...'" : "'");
}

}  // namespace plica
