// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>
#include <plica/meshes/base64.hpp>
#include <plica/meshes/vtk/vtu_arrays.hpp>

namespace plica {

namespace {

struct TypeName {
  const char* name;
  NumberType type;
};
constexpr TypeName type_names[] = {
    {"Int8", NumberType::int8},       {"UInt8", NumberType::uint8},   {"Int16", NumberType::int16},
    {"UInt16", NumberType::uint16},   {"Int32", NumberType::int32},   {"UInt32", NumberType::uint32},
    {"Int64", NumberType::int64},     {"UInt64", NumberType::uint64}, {"Float32", NumberType::float32},
    {"Float64", NumberType::float64},
};

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  while (!text.empty() && blanks.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return text;
}

// Takes `word` from the end of `text`, and blanks before it
bool take_last(std::string_view& text, std::string_view word) {
  if (!text.ends_with(word)) return false;
  text.remove_suffix(word.size());
  while (!text.empty() && blanks.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return true;
}

std::string place_of(const XmlElement& array) {
  const auto name = array.attributes.find("Name");
  return "the array " + shown(name == array.attributes.end() ? "" : name->second);
}

}  // namespace

const std::string& attribute(const XmlElement& element, const std::string& key, const MemoryFile& file) {
  const auto found = element.attributes.find(key);
  if (found == element.attributes.end()) refuse(file.name, element.place, "<" + element.name + "> has no " + key);
  return found->second;
}

std::int64_t attribute_count(const XmlElement& element, const std::string& key, const MemoryFile& file) {
  const std::string& text = attribute(element, key, file);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0)
    refuse(file.name, element.place, key + " is " + shown(text) + "; it must be an integer from 0");
  return value;
}

NumberType vtu_type(const XmlElement& array, const MemoryFile& file) {
  const std::string& name = attribute(array, "type", file);
  std::vector<std::string> choices;
  for (const TypeName& known : type_names) {
    if (name == known.name) return known.type;
    choices.emplace_back(known.name);
  }
  const std::string quoted = shown(name);
  refuse(file.name, array.place, unknown_name("type of numbers", quoted.substr(1, quoted.size() - 2), choices));
}

void VtuArrays::header(const XmlElement& element) {
  if (const auto found = element.attributes.find("compressor"); found != element.attributes.end())
    refuse(file_.name, element.place,
           "the arrays are compressed by " + shown(found->second) +
               "; supported are ascii, base64 and raw arrays without compression");
  const std::string& order = attribute(element, "byte_order", file_);
  if (order != "LittleEndian" && order != "BigEndian")
    refuse(file_.name, element.place, "byte_order is " + shown(order) + "; it must be LittleEndian or BigEndian");
  order_ = order == "BigEndian" ? std::endian::big : std::endian::little;
  const auto length = element.attributes.find("header_type");
  if (length == element.attributes.end() || length->second == "UInt32") return;
  if (length->second != "UInt64")
    refuse(file_.name, element.place, "header_type is " + shown(length->second) + "; it must be UInt32 or UInt64");
  length_type_ = NumberType::uint64;
}

bool VtuArrays::appended(const XmlElement& element) {
  const std::string& encoding = attribute(element, "encoding", file_);
  if (encoding != "raw" && encoding != "base64")
    refuse(file_.name, element.place, "encoding is " + shown(encoding) + "; it must be raw or base64");
  const std::string_view all = file_.bytes;
  begin_ = all.find_first_not_of(blanks, element.text_begin);
  if (element.empty || begin_ >= all.size() || all[begin_] != '_')
    refuse(file_.name, element.place, "the appended data do not begin with '_'");
  ++begin_, has_appended_ = true, raw_ = encoding == "raw";
  if (!raw_) {
    end_ = element.text_end;
    return false;
  }
  std::string_view rest = all.substr(begin_);
  while (!rest.empty() && blanks.find(rest.back()) != std::string_view::npos) rest.remove_suffix(1);
  if (!take_last(rest, "</VTKFile>") || !rest.ends_with("</AppendedData>"))
    refuse(file_.name, {0, static_cast<std::int64_t>(all.size())},
           "expected </AppendedData> and </VTKFile> at the end of the file");
  end_ = begin_ + rest.size() - std::string_view("</AppendedData>").size();
  return true;
}

void VtuArrays::read(const XmlElement& array, const Take& take) const {
  const NumberType type = vtu_type(array, file_);
  const std::string& format = attribute(array, "format", file_);
  if (format == "ascii") return read_ascii(array, type, take);
  if (format == "binary") {
    const std::string_view text =
        std::string_view(file_.bytes).substr(array.text_begin, array.text_end - array.text_begin);
    return read_bytes(decoded(trimmed(text), true, array.place), array.place, type, take);
  }
  if (format != "appended")
    refuse(file_.name, array.place,
           "the format of " + place_of(array) + " is " + shown(format) + "; it must be ascii, binary or appended");
  const std::string_view bytes = appended_at(array);
  if (!raw_) return read_bytes(decoded(bytes, false, array.place), array.place, type, take);
  const Place place{0, bytes.data() - file_.bytes.data()};
  const std::uint64_t size = length(bytes, place), head = bytes_of(length_type_);
  if (size > bytes.size() - head)
    refuse(file_.name, place,
           place_of(array) + " has " + std::to_string(size) + " bytes, but " + std::to_string(bytes.size() - head) +
               " are left");
  read_bytes(bytes.substr(0, head + size), place, type, take);
}

void VtuArrays::read_ascii(const XmlElement& array, NumberType type, const Take& take) const {
  TextLines lines(file_, array.text_begin, array.text_end, array.text_line);
  TextNumbers numbers(lines, true);
  take(numbers, type);
  numbers.end(place_of(array));
  if (lines.next()) lines.fail(shown(lines.text()) + " is too much for " + place_of(array));
}

// The length in bytes, then the numbers
void VtuArrays::read_bytes(std::string_view bytes, const Place& place, NumberType type, const Take& take) const {
  const std::size_t head = bytes_of(length_type_);
  const std::uint64_t size = length(bytes, place);
  if (size != bytes.size() - head)
    refuse(file_.name, place,
           "an array has " + std::to_string(bytes.size() - head) + " bytes and not " + std::to_string(size) +
               ", as it says");
  const Place first = place.line > 0 ? place : Place{0, place.byte + static_cast<std::int64_t>(head)};
  ByteNumbers numbers(file_.name, bytes.substr(head), order_, first);
  take(numbers, type);
  if (numbers.left() > 0) numbers.fail(std::to_string(numbers.left()) + " bytes are too much for an array");
}

std::uint64_t VtuArrays::length(std::string_view bytes, const Place& place) const {
  ByteNumbers numbers(file_.name, bytes, order_, place);
  return static_cast<std::uint64_t>(numbers.integer(length_type_, "the length of an array"));
}

std::string_view VtuArrays::appended_at(const XmlElement& array) const {
  const std::int64_t offset = attribute_count(array, "offset", file_);
  const std::size_t room = end_ - begin_;
  if (!has_appended_) refuse(file_.name, array.place, place_of(array) + " is appended, but there is no <AppendedData>");
  if (offset > static_cast<std::int64_t>(room))
    refuse(file_.name, array.place,
           "the offset of " + place_of(array) + " is " + std::to_string(offset) + ", but the appended data have " +
               std::to_string(room) + " bytes");
  return std::string_view(file_.bytes).substr(begin_, room).substr(static_cast<std::size_t>(offset));
}

// Length and numbers are encoded together, but some writers pad the length and begin anew. `exactly`: all of the text.
std::string VtuArrays::decoded(std::string_view text, bool exactly, const Place& place) const {
  const auto bad = [&]() { refuse(file_.name, place, "an array is no whole base64 text"); };
  const std::size_t head = bytes_of(length_type_), head_size = base64_size(head);
  if (text.size() < head_size) bad();
  const auto start = decode_base64(text.substr(0, head_size));
  if (!start || start->size() < head) bad();
  const std::uint64_t size = length(*start, place);
  if (size > text.size()) bad();
  const bool apart = start->size() == head && size > 0;
  const std::size_t from = apart ? head_size : 0, bytes = (apart ? 0 : head) + static_cast<std::size_t>(size);
  const std::size_t end = from + base64_size(bytes);
  if (text.size() < end || (exactly && text.size() != end)) bad();
  const auto rest = decode_base64(text.substr(from, end - from));
  if (!rest) bad();
  return apart ? *start + *rest : *rest;
}

}  // namespace plica
