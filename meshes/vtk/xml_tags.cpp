// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <plica/meshes/vtk/xml_tags.hpp>

namespace plica {

namespace {

constexpr std::string_view blanks = " \t\r\n";
constexpr std::size_t deepest = 64;

bool is_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':' || c == '-' || c == '.';
}

}  // namespace

void XmlTags::go_to(std::size_t at) {
  at = std::min(at, text_.size());
  line_ += std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_), text_.begin() + static_cast<std::ptrdiff_t>(at),
                      '\n');
  at_ = at;
}

void XmlTags::skip_blanks() { go_to(text_.find_first_not_of(blanks, at_)); }

bool XmlTags::take(std::string_view word) {
  if (!text_.substr(at_).starts_with(word)) return false;
  go_to(at_ + word.size());
  return true;
}

void XmlTags::skip_past(std::string_view mark, const char* what) {
  const std::size_t end = text_.find(mark, at_);
  if (end == std::string_view::npos) fail(std::string(what) + " has no end " + shown(mark));
  go_to(end + mark.size());
}

// Text between tags is passed over, but outside of all elements there may be none
void XmlTags::skip_to_tag() {
  for (;;) {
    if (open_.empty()) skip_blanks();
    if (open_.empty() && at_ < text_.size() && peek() != '<')
      fail("expected an XML tag, found " + shown(text_.substr(at_)));
    go_to(text_.find('<', at_));
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("<!--"))
      skip_past("-->", "a comment");
    else if (rest.starts_with("<?"))
      skip_past("?>", "a declaration");
    else if (rest.starts_with("<!"))
      fail("document types and CDATA are not supported: " + shown(rest.substr(0, 20)));
    else
      return;
  }
}

XmlTags::Event XmlTags::next() {
  skip_to_tag();
  if (at_ == text_.size()) {
    if (!open_.empty()) fail("<" + open_.back() + "> has no end: the file ends");
    if (!seen_root_) fail("expected an XML tag, but the file ends");
    return Event::finished;
  }
  if (take("</")) return end_tag(), Event::end;
  take("<");
  start_tag();
  return Event::start;
}

std::string XmlTags::name(const char* what) {
  const std::size_t begin = at_;
  while (at_ < text_.size() && is_name(text_[at_])) ++at_;
  if (at_ == begin) fail(std::string("expected ") + what + ", found " + shown(text_.substr(at_, 20)));
  return std::string(text_.substr(begin, at_ - begin));
}

void XmlTags::end_tag() {
  const std::string ended = name("the name of an element");
  skip_blanks();
  if (!take(">")) fail("expected the end of the tag </" + ended + ">, found " + shown(text_.substr(at_, 20)));
  if (open_.empty() || open_.back() != ended)
    fail("</" + ended + "> where " + (open_.empty() ? "nothing" : "<" + open_.back() + ">") + " is open");
  open_.pop_back();
}

void XmlTags::start_tag() {
  element_ = {};
  element_.place = {line_};
  element_.name = name("the name of an element");
  if (open_.empty() && seen_root_) fail("a second outermost element <" + element_.name + ">");
  seen_root_ = true;
  for (;;) {
    const std::size_t before = at_;
    skip_blanks();
    element_.empty = take("/>");
    if (element_.empty || take(">")) break;
    if (at_ == before || at_ == text_.size())
      fail("expected an attribute or the end of the tag <" + element_.name + ">, found " +
           shown(text_.substr(at_, 20)));
    attribute();
  }
  element_.text_begin = at_;
  element_.text_end = element_.empty ? at_ : std::min(text_.find('<', at_), text_.size());
  element_.text_line = line_;
  if (element_.empty) return;
  if (open_.size() == deepest) fail("elements are nested more than " + std::to_string(deepest) + " deep");
  open_.push_back(element_.name);
}

void XmlTags::attribute() {
  const std::string key = name("the name of an attribute");
  skip_blanks();
  const bool assigned = take("=");
  skip_blanks();
  const char quote = peek();
  if (!assigned || (quote != '"' && quote != '\'')) fail("expected =\"...\" after the attribute " + shown(key));
  const std::size_t begin = at_ + 1, end = text_.find(quote, begin);
  if (end == std::string_view::npos) fail("the value of the attribute " + shown(key) + " has no end");
  if (!element_.attributes.emplace(key, value(text_.substr(begin, end - begin))).second)
    fail("a second attribute " + shown(key) + " of <" + element_.name + ">");
  go_to(end + 1);
}

// With the five entities that XML itself defines
std::string XmlTags::value(std::string_view quoted) const {
  constexpr std::pair<std::string_view, char> entities[] = {
      {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string text;
  while (!quoted.empty()) {
    char c = quoted.front();
    std::size_t used = 1;
    if (c == '&') {
      const auto entity = std::find_if(std::begin(entities), std::end(entities),
                                       [&](const auto& e) { return quoted.starts_with(e.first); });
      if (entity == std::end(entities)) fail("unknown entity " + shown(quoted.substr(0, 10)));
      c = entity->second, used = entity->first.size();
    }
    text += c;
    quoted.remove_prefix(used);
  }
  return text;
}

}  // namespace plica
