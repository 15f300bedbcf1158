// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <plica/meshes/files/base64.hpp>
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/files/vtu_arrays.hpp>
#include <pugixml.hpp>

namespace plica {

namespace {

struct TypeName {
  const char* name;
  NumberType type;
};
constexpr TypeName type_names[] = {
    {"Int8", NumberType::int8},       {"UInt8", NumberType::uint8},
    {"Int16", NumberType::int16},     {"UInt16", NumberType::uint16},
    {"Int32", NumberType::int32},     {"UInt32", NumberType::uint32},
    {"Int64", NumberType::int64},     {"UInt64", NumberType::uint64},
    {"Float32", NumberType::float32}, {"Float64", NumberType::float64},
};

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  while (!text.empty() && blanks.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return text;
}

// Removes `word` and the blanks before it from the end of `text`; returns false if it is not there
bool take_last(std::string_view& text, std::string_view word) {
  if (!text.ends_with(word)) return false;
  text.remove_suffix(word.size());
  while (!text.empty() && blanks.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return true;
}

// Returns the byte after the '>' of the start tag that begins at `begin`; npos: it does not end
std::size_t end_of_tag(std::string_view text, std::size_t begin) {
  char quote = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0 ? c == quote : c == '"' || c == '\'') quote = quote != 0 ? '\0' : c;
    if (quote == 0 && c == '>') return i + 1;
  }
  return std::string_view::npos;
}

std::string place_of(const XmlElement& array) {
  const auto name = array.attributes.find("Name");
  return "the array " + shown(name == array.attributes.end() ? "" : name->second);
}

}  // namespace

const std::string& attribute(const XmlElement& element, const std::string& key,
                             const FileBytes& file) {
  const auto found = element.attributes.find(key);
  if (found == element.attributes.end())
    refuse(file.name, element.place, "<" + element.name + "> has no " + key);
  return found->second;
}

std::int64_t attribute_count(const XmlElement& element, const std::string& key,
                             const FileBytes& file) {
  const std::string& text = attribute(element, key, file);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0)
    refuse(file.name, element.place, key + " is " + shown(text) + "; it must be an integer from 0");
  return value;
}

NumberType vtu_type(const XmlElement& array, const FileBytes& file) {
  const std::string& name = attribute(array, "type", file);
  std::vector<std::string> choices;
  for (const TypeName& known : type_names) {
    if (name == known.name) return known.type;
    choices.emplace_back(known.name);
  }
  refuse(file.name, array.place, unknown_name("type of numbers", printable(name), choices));
}

std::vector<XmlElement> vtu_elements(const FileBytes& file) {
  const std::string_view all = file.bytes;
  LineNumbers lines(all);
  const auto refuse_at = [&](std::size_t byte, const std::string& message) {
    refuse(file.name, {lines.of(std::min(byte, all.size()))}, message);
  };
  const std::size_t data = end_of_tag(all, std::min(all.find("<AppendedData"), all.size()));
  const bool cut = data != std::string_view::npos && all[data - 2] != '/';
  const std::string head =
      cut ? std::string(all.substr(0, data)) + "</AppendedData></VTKFile>" : file.bytes;
  if (const std::size_t zero = head.find('\0'); zero != std::string::npos)
    refuse_at(zero, "the XML holds a zero byte");

  pugi::xml_document document;
  const auto parsed =
      document.load_buffer(head.data(), head.size(),
                           pugi::parse_escapes | pugi::parse_comments | pugi::parse_cdata |
                               pugi::parse_doctype | pugi::parse_fragment,
                           pugi::encoding_utf8);
  if (!parsed) {
    std::size_t at = head.rfind('<', static_cast<std::size_t>(parsed.offset));
    if (parsed.status == pugi::status_bad_comment) {  // pugixml gives the end of the file as place
      const std::size_t ended = head.rfind("-->");
      at = head.find("<!--", ended == std::string::npos ? 0 : ended);
    }
    if (at == std::string::npos) at = static_cast<std::size_t>(parsed.offset);
    refuse_at(at, "the XML is malformed: " + lower_case(parsed.description()) + " at " +
                      shown(head.substr(at)));
  }
  std::vector<XmlElement> elements;
  const auto take = [&](const pugi::xml_node& node) {
    const std::size_t at =
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
    if (node.type() == pugi::node_cdata || node.type() == pugi::node_doctype)
      refuse_at(at, "document types and CDATA are not supported");
    const bool outermost = node.parent() == document;
    if (node.type() == pugi::node_pcdata && outermost) {
      const std::size_t text = head.find_first_not_of(blanks, at);
      refuse_at(text, "expected an XML tag, found " + shown(head.substr(text)));
    }
    if (node.type() != pugi::node_element) return;
    if (outermost && !elements.empty())
      refuse_at(at, "a second outermost element <" + std::string(node.name()) + ">");
    XmlElement element{node.name(), node.parent().name(), {}, {lines.of(at)}};
    for (const pugi::xml_attribute& a : node.attributes())
      if (!element.attributes.emplace(a.name(), a.value()).second)
        refuse_at(at, "a second attribute " + shown(a.name()) + " of <" + element.name + ">");
    const pugi::xml_node text = node.first_child();
    element.text_begin = element.text_end = at;
    if (text.type() == pugi::node_pcdata) {
      element.text_begin = static_cast<std::size_t>(text.offset_debug());
      element.text_end = std::min(all.find('<', element.text_begin), all.size());
    }
    if (cut && element.name == "AppendedData") element.text_begin = element.text_end = data;
    element.text_line = lines.of(element.text_begin);
    elements.push_back(std::move(element));
  };
  for (pugi::xml_node node = document.first_child(); node;) {
    take(node);
    if (node.first_child()) {
      node = node.first_child();
      continue;
    }
    while (node && !node.next_sibling()) node = node.parent();
    if (node) node = node.next_sibling();
  }
  if (elements.empty()) refuse_at(all.size(), "expected an XML tag, but the file ends");
  return elements;
}

void VtuArrays::header(const XmlElement& element) {
  if (const auto found = element.attributes.find("compressor"); found != element.attributes.end())
    compressor_ = found->second;
  const std::string& order = attribute(element, "byte_order", file_);
  if (order != "LittleEndian" && order != "BigEndian")
    refuse(file_.name, element.place,
           "byte_order is " + shown(order) + "; it must be LittleEndian or BigEndian");
  order_ = order == "BigEndian" ? std::endian::big : std::endian::little;
  const auto length = element.attributes.find("header_type");
  if (length == element.attributes.end() || length->second == "UInt32") return;
  if (length->second != "UInt64")
    refuse(file_.name, element.place,
           "header_type is " + shown(length->second) + "; it must be UInt32 or UInt64");
  length_type_ = NumberType::uint64;
}

void VtuArrays::appended(const XmlElement& element) {
  const std::string& encoding = attribute(element, "encoding", file_);
  if (encoding != "raw" && encoding != "base64")
    refuse(file_.name, element.place,
           "encoding is " + shown(encoding) + "; it must be raw or base64");
  const std::string_view all = file_.bytes;
  begin_ = all.find_first_not_of(blanks, element.text_begin);
  if (begin_ >= all.size() || all[begin_] != '_')
    refuse(file_.name, element.place, "the appended data do not begin with '_'");
  ++begin_, has_appended_ = true, raw_ = encoding == "raw";
  std::string_view rest = all.substr(begin_);
  while (!rest.empty() && blanks.find(rest.back()) != std::string_view::npos) rest.remove_suffix(1);
  if (!take_last(rest, "</VTKFile>") || !rest.ends_with("</AppendedData>"))
    refuse(file_.name, {0, static_cast<std::int64_t>(all.size())},
           "expected </AppendedData> and </VTKFile> at the end of the file");
  end_ = begin_ + rest.size() - std::string_view("</AppendedData>").size();
}

void VtuArrays::read(const XmlElement& array, const Take& take) const {
  const NumberType type = vtu_type(array, file_);
  const std::string& format = attribute(array, "format", file_);
  if (format == "ascii") return read_ascii(array, type, take);
  if (format == "binary") {
    const std::string_view text =
        std::string_view(file_.bytes).substr(array.text_begin, array.text_end - array.text_begin);
    if (!compressor_.empty())
      return read_compressed(trimmed(text), true, array, array.place, type, take);
    return read_bytes(decoded(trimmed(text), true, array.place), array.place, type, take);
  }
  if (format != "appended")
    refuse(file_.name, array.place,
           "the format of " + place_of(array) + " is " + shown(format) +
               "; it must be ascii, binary or appended");
  const std::string_view bytes = appended_at(array);
  if (!compressor_.empty())
    return read_compressed(bytes, !raw_, array,
                           raw_ ? Place{0, bytes.data() - file_.bytes.data()} : array.place, type,
                           take);
  if (!raw_) return read_bytes(decoded(bytes, false, array.place), array.place, type, take);
  const Place place{0, bytes.data() - file_.bytes.data()};
  const std::uint64_t size = length(bytes, place), head = bytes_of(length_type_);
  if (size > bytes.size() - head)
    refuse(file_.name, place,
           place_of(array) + " has " + std::to_string(size) + " bytes, but " +
               std::to_string(bytes.size() - head) + " are left");
  read_bytes(bytes.substr(0, head + size), place, type, take);
}

void VtuArrays::read_ascii(const XmlElement& array, NumberType type, const Take& take) const {
  TextLines lines(file_, array.text_begin, array.text_end, array.text_line);
  TextNumbers numbers(lines, true);
  take(numbers, type);
  numbers.end(place_of(array));
  if (lines.next()) lines.fail(shown(lines.text()) + " is too much for " + place_of(array));
}

// Reads the length in bytes, then the numbers
void VtuArrays::read_bytes(std::string_view bytes, const Place& place, NumberType type,
                           const Take& take) const {
  const std::size_t head = bytes_of(length_type_);
  const std::uint64_t size = length(bytes, place);
  if (size != bytes.size() - head)
    refuse(file_.name, place,
           "an array has " + std::to_string(bytes.size() - head) + " bytes and not " +
               std::to_string(size) + ", as it says");
  const Place first =
      place.line > 0 ? place : Place{0, place.byte + static_cast<std::int64_t>(head)};
  ByteNumbers numbers(file_.name, bytes.substr(head), order_, first);
  take(numbers, type);
  if (numbers.left() > 0)
    numbers.fail(std::to_string(numbers.left()) + " bytes are too much for an array");
}

// Reads a compressed array. Its head is the number of blocks, their size, the size of the last one
// (0: as the others), and the compressed size of each; then come the blocks. In base64 the head is
// encoded separately.
void VtuArrays::read_compressed(std::string_view text, bool base64, const XmlElement& array,
                                const Place& place, NumberType type, const Take& take) const {
  const auto bad = [&](const std::string& what) {
    refuse(file_.name, place, place_of(array) + " " + what);
  };
  const Compressor* compressor = find_compressor(compressor_);
  if (!compressor)
    bad("is compressed by " + shown(compressor_) + "; supported are " + compressor_names() +
        ", or none");
  const std::size_t word = bytes_of(length_type_);
  const auto take_part = [&](std::size_t bytes) {
    const std::size_t size = base64 ? base64_size(bytes) : bytes;
    if (bytes > text.size() || size > text.size()) bad("is cut short");
    const std::string_view part = text.substr(0, size);
    std::optional<std::string> decoded = base64 ? decode_base64(part) : std::string(part);
    if (!decoded || decoded->size() < bytes) bad("is no whole base64 text");
    return *decoded;
  };
  const std::size_t blocks = length(take_part(word), place);
  if (blocks > text.size() / word)
    bad("has " + std::to_string(blocks) + " blocks, for which there is no room");
  const std::string head = take_part(blocks == 0 ? word : (3 + blocks) * word);
  const auto head_at = [&](std::size_t i) {
    return length(std::string_view(head).substr(i * word), place);
  };
  text.remove_prefix(base64 ? base64_size(blocks == 0 ? word : head.size()) : head.size());
  std::size_t compressed = 0;
  for (std::size_t b = 0; b < blocks; ++b)
    if ((compressed += std::min(head_at(3 + b), text.size() + 1)) > text.size())
      bad("is cut short");
  const std::string data = take_part(compressed);
  std::string bytes;
  for (std::size_t b = 0, at = 0; b < blocks; ++b) {
    const std::size_t whole = head_at(1), last = head_at(2), packed = head_at(3 + b);
    const std::size_t size = b + 1 == blocks && last > 0 ? last : whole;
    if (size / compressor->largest_ratio > packed)
      bad("tells an absurd size of a block: " + std::to_string(size));
    const auto block = compressor->decompress(std::string_view(data).substr(at, packed), size);
    if (!block) bad("has a block that cannot be decompressed");
    bytes += *block, at += packed;
  }
  const Place nowhere = array.place;
  ByteNumbers numbers(file_.name, bytes, order_, nowhere);
  take(numbers, type);
  if (numbers.left() > 0)
    numbers.fail(std::to_string(numbers.left()) + " bytes are too much for an array");
}

std::uint64_t VtuArrays::length(std::string_view bytes, const Place& place) const {
  ByteNumbers numbers(file_.name, bytes, order_, place);
  return static_cast<std::uint64_t>(numbers.integer(length_type_, "the length of an array"));
}

std::string_view VtuArrays::appended_at(const XmlElement& array) const {
  const std::int64_t offset = attribute_count(array, "offset", file_);
  const std::size_t room = end_ - begin_;
  if (!has_appended_)
    refuse(file_.name, array.place,
           place_of(array) + " is appended, but there is no <AppendedData>");
  if (offset > static_cast<std::int64_t>(room))
    refuse(file_.name, array.place,
           "the offset of " + place_of(array) + " is " + std::to_string(offset) +
               ", but the appended data have " + std::to_string(room) + " bytes");
  return std::string_view(file_.bytes)
      .substr(begin_, room)
      .substr(static_cast<std::size_t>(offset));
}

// Returns the decoded length and numbers of an array. They are encoded together, but some writers
// encode the length separately, with padding. `exactly`: the array must be all of the text.
std::string VtuArrays::decoded(std::string_view text, bool exactly, const Place& place) const {
  const auto bad = [&]() { refuse(file_.name, place, "an array is no whole base64 text"); };
  const std::size_t head = bytes_of(length_type_), head_size = base64_size(head);
  if (text.size() < head_size) bad();
  const auto start = decode_base64(text.substr(0, head_size));
  if (!start || start->size() < head) bad();
  const std::uint64_t size = length(*start, place);
  if (size > text.size()) bad();
  const bool apart = start->size() == head && size > 0;
  const std::size_t from = apart ? head_size : 0,
                    bytes = (apart ? 0 : head) + static_cast<std::size_t>(size);
  const std::size_t end = from + base64_size(bytes);
  if (text.size() < end || (exactly && text.size() != end)) bad();
  auto rest = decode_base64(text.substr(from, end - from));
  if (!rest) bad();
  return apart ? *start + *rest : std::move(*rest);
}

}  // namespace plica
