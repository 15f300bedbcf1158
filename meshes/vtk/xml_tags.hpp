// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <plica/meshes/memory_file.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// A start tag of XML and the text between it and the next tag.
struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  Place place;
  bool empty = false;          ///< <name/>: no text, and its end is not told again
  std::size_t text_begin = 0;  ///< bytes
  std::size_t text_end = 0;
  std::int64_t text_line = 0;  ///< where it begins
};

/// The tags of an XML file in order, as far as VTK's files go: elements, attributes, comments and the declaration; no
/// document types and no CDATA. Nesting and quotes are checked, and every complaint names the line.
///
/// Why not a library: the raw data at the end of such a file are no XML, so that no parser takes the file as it is; the
/// library plica needs Kokkos and Eigen only; and what is left to parse is this small.
class XmlTags {
 public:
  explicit XmlTags(const MemoryFile& file) : file_(file), text_(file.bytes) {}

  enum class Event { start, end, finished };
  /// Goes to the next tag. Elements stay open until their end; an empty one has none.
  Event next();

  const XmlElement& element() const { return element_; }                   ///< that has started
  const std::vector<std::string>& open_elements() const { return open_; }  ///< outermost first

 private:
  void skip_to_tag();
  void skip_past(std::string_view mark, const char* what);
  void start_tag();
  void end_tag();
  void attribute();
  std::string name(const char* what);
  std::string value(std::string_view quoted) const;
  void skip_blanks();
  bool take(std::string_view word);
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void go_to(std::size_t at);
  [[noreturn]] void fail(const std::string& message) const { refuse(file_.name, {line_}, message); }

  const MemoryFile& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
  bool seen_root_ = false;
  XmlElement element_;
  std::vector<std::string> open_;
};

}  // namespace plica
