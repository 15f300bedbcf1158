// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/text.hpp>
#include <plica/meshes/files/image_parts.hpp>

namespace plica {

namespace {

struct MetaType {
  std::string_view name;
  NumberType type;
};
constexpr MetaType meta_types[] = {
    {"met_char", NumberType::int8},       {"met_uchar", NumberType::uint8},
    {"met_short", NumberType::int16},     {"met_ushort", NumberType::uint16},
    {"met_int", NumberType::int32},       {"met_uint", NumberType::uint32},
    {"met_long", NumberType::int32},      {"met_ulong", NumberType::uint32},
    {"met_long_long", NumberType::int64}, {"met_ulong_long", NumberType::uint64},
    {"met_float", NumberType::float32},   {"met_double", NumberType::float64},
};

// Reads lines "Key = value", of which the last is ElementDataFile
class MetaImageParser {
 public:
  explicit MetaImageParser(const FileBytes& file) : file_(file) {}

  LabelFile parse() {
    read_fields();
    heading_.file.format = "MetaImage", heading_.file.unit = 0.001;
    expect({"elementdatafile"}, "local", "LOCAL, the voxels in the same file, as .mha");
    expect({"ndims"}, "3", "3");
    expect({"elementnumberofchannels"}, "1", "1, a label for each voxel");
    expect({"binarydata"}, "true", "True");
    expect({"headersize"}, "0", "0");
    const auto size = numbers_of({"dimsize"}, 3);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(size[k] >= 1 && size[k] <= 1e9)) fail("dimsize", "whole numbers above 0");
      heading_.size[k] = static_cast<std::int64_t>(size[k]);
    }
    const auto type = std::ranges::find(meta_types, value("elementtype"), &MetaType::name);
    if (type == std::end(meta_types)) fail("elementtype", "a number, such as MET_UCHAR");
    heading_.type = type->type;
    const std::string msb = either({"binarydatabyteordermsb", "elementbyteordermsb"});
    heading_.order = !msb.empty() && value(msb) == "true" ? std::endian::big : std::endian::little;
    read_axes();
    const std::string_view rest = std::string_view(file_.bytes).substr(data_);
    const Place first{0, static_cast<std::int64_t>(data_)};
    if (!fields_.contains("compresseddata") || value("compresseddata") != "true")
      return with_labels(std::move(heading_), file_.name, rest, first);
    const std::size_t bytes = checked_voxels(heading_, file_.name) * bytes_of(heading_.type);
    return with_labels(std::move(heading_), file_.name, inflated(rest, bytes, file_.name), first);
  }

 private:
  struct Field {
    std::string text;
    Place place;
  };
  using Names = std::vector<std::string>;

  void read_fields() {
    for (std::int64_t line = 1; !fields_.contains("elementdatafile"); ++line) {
      const std::size_t end = file_.bytes.find('\n', data_);
      if (end == std::string::npos)
        refuse(file_.name, {line, -1}, "the heading ends without ElementDataFile");
      const std::string_view row = std::string_view(file_.bytes).substr(data_, end - data_);
      data_ = end + 1;
      const std::size_t equals = row.find('=');
      if (list_words(row).empty()) continue;
      if (equals == std::string_view::npos || list_words(row.substr(0, equals)).size() != 1)
        refuse(file_.name, {line, -1}, "expected 'Key = value', found " + shown(row));
      std::string text;
      for (const std::string_view word : list_words(row.substr(equals + 1)))
        text += (text.empty() ? "" : " ") + std::string(word);
      fields_[lower_case(list_words(row.substr(0, equals)).front())] = {text, {line, -1}};
    }
  }

  [[noreturn]] void fail(const std::string& field, const std::string& expected) const {
    const Field& one = fields_.at(field);
    refuse(file_.name, one.place, field + " is " + shown(one.text) + "; expected " + expected);
  }

  // Returns the first of these names that the file has; empty: none
  std::string either(const Names& names) const {
    for (const std::string& name : names)
      if (fields_.contains(name)) return name;
    return {};
  }
  std::string value(const std::string& field) const {
    const auto found = fields_.find(field);
    if (found == fields_.end()) refuse(file_.name, {}, "the key " + field + " is missing");
    return lower_case(found->second.text);
  }
  void expect(const Names& names, const std::string& wanted, const std::string& words) const {
    const std::string name = either(names);
    if (!name.empty() && value(name) != wanted) fail(name, words);
  }
  std::vector<double> numbers_of(const Names& names, std::size_t count) const {
    const std::string name = either(names);
    if (name.empty()) refuse(file_.name, {}, "the key " + names.front() + " is missing");
    const Field& one = fields_.at(name);
    return list_numbers(one.text, count, name, file_.name, one.place);
  }

  // The matrix has the direction of each axis in a row
  void read_axes() {
    LabelImage& image = heading_.file.image;
    const Names matrix = {"transformmatrix", "rotation", "orientation"},
                origin = {"offset", "origin", "position"},
                spacing = {"elementspacing", "elementsize"};
    if (!either(matrix).empty()) {
      const auto all = numbers_of(matrix, 9);
      for (int k = 0; k < 9; ++k) image.axes(k % 3, k / 3) = all[static_cast<std::size_t>(k)];
    }
    if (!either(spacing).empty()) {
      const auto all = numbers_of(spacing, 3);
      for (int k = 0; k < 3; ++k) image.axes.col(k) *= all[static_cast<std::size_t>(k)];
    }
    if (either(origin).empty()) return;
    const auto all = numbers_of(origin, 3);
    image.origin = Point(all[0], all[1], all[2]);
  }

  const FileBytes& file_;
  std::map<std::string, Field> fields_;
  ImageHeading heading_;
  std::size_t data_ = 0;  // first byte after the lines that were read
};

}  // namespace

LabelFile parse_metaimage(const FileBytes& file) { return MetaImageParser(file).parse(); }

}  // namespace plica
