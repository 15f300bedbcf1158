// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/text.hpp>
#include <plica/meshes/files/image_parts.hpp>

namespace plica {

namespace {

// Names of types in NRRD's definition; the first name of each row is the short one of C
struct NrrdType {
  std::vector<std::string_view> names;
  NumberType type;
};
const NrrdType nrrd_types[] = {
    {{"signed char", "int8", "int8_t"}, NumberType::int8},
    {{"uchar", "unsigned char", "uint8", "uint8_t"}, NumberType::uint8},
    {{"short", "short int", "signed short", "signed short int", "int16", "int16_t"},
     NumberType::int16},
    {{"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}, NumberType::uint16},
    {{"int", "signed int", "int32", "int32_t"}, NumberType::int32},
    {{"uint", "unsigned int", "uint32", "uint32_t"}, NumberType::uint32},
    {{"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64",
      "int64_t"},
     NumberType::int64},
    {{"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"},
     NumberType::uint64},
    {{"float"}, NumberType::float32},
    {{"double"}, NumberType::float64},
};

class NrrdParser {
 public:
  explicit NrrdParser(const FileBytes& file) : file_(file) {}

  LabelFile parse() {
    read_fields();
    heading_.file.format = "NRRD";
    for (const char* other : {"data file", "datafile"})
      if (fields_.contains(other)) fail(other, "; expected the voxels in the same file, as .nrrd");
    for (const char* skip : {"line skip", "byte skip", "lineskip", "byteskip"})
      if (const auto found = fields_.find(skip);
          found != fields_.end() && found->second.text != "0")
        fail(skip, "; expected 0");
    if (const std::string dimension = text_of("dimension"); dimension != "3")
      fail("dimension", "; expected 3, a number for each voxel");
    const auto size = numbers_of("sizes", 3);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(size[k] >= 1 && size[k] <= 1e9)) fail("sizes", "; expected whole numbers above 0");
      heading_.size[k] = static_cast<std::int64_t>(size[k]);
    }
    read_type();
    read_axes();
    name_segments();
    return read_voxels();
  }

 private:
  struct Field {
    std::string text;
    Place place;
  };

  [[noreturn]] void fail(const std::string& field, const std::string& expected) const {
    const std::string text = text_of(field);
    refuse(file_.name, fields_.at(field).place, field + " is " + shown(text) + expected);
  }

  // Reads the lines "field: value" and "key:=value" up to the blank line before the voxels
  void read_fields() {
    for (std::int64_t line = 1;; ++line) {
      const std::size_t end = file_.bytes.find('\n', data_);
      if (end == std::string::npos)
        refuse(file_.name, {line, -1}, "the heading ends without a blank line");
      std::string_view text = std::string_view(file_.bytes).substr(data_, end - data_);
      data_ = end + 1;
      if (text.ends_with('\r')) text.remove_suffix(1);
      if (text.empty()) return void(first_line_ = line + 1);
      if (line == 1 || text.front() == '#') continue;
      const std::size_t colon = text.find(':');
      if (colon == std::string_view::npos)
        refuse(file_.name, {line, -1}, "expected 'field: value', found " + shown(text));
      const bool key = text.substr(colon).starts_with(":=");
      const std::string name(text.substr(0, colon));
      std::string_view value = text.substr(colon + (key ? 2 : 1));
      while (value.starts_with(' ')) value.remove_prefix(1);
      while (value.ends_with(' ')) value.remove_suffix(1);
      (key ? keys_[name] : fields_[lower_case(name)]) = {std::string(value), {line, -1}};
    }
  }

  std::string text_of(const std::string& field) const {
    const auto found = fields_.find(field);
    if (found == fields_.end()) refuse(file_.name, {}, "the field " + field + " is missing");
    return found->second.text;
  }

  std::vector<double> numbers_of(const std::string& field, std::size_t count) const {
    const std::string text = text_of(field);
    return list_numbers(text, count, field, file_.name, fields_.at(field).place);
  }

  void read_type() {
    const std::string name = lower_case(text_of("type"));
    const auto found = std::ranges::find_if(nrrd_types, [&](const NrrdType& one) {
      return std::ranges::find(one.names, name) != one.names.end();
    });
    if (found == std::end(nrrd_types)) fail("type", "; expected a number, such as uchar or short");
    heading_.type = found->type;
    if (bytes_of(heading_.type) == 1 || is_text()) return;
    const std::string order = lower_case(text_of("endian"));
    if (order != "little" && order != "big") fail("endian", "; expected little or big");
    heading_.order = order == "big" ? std::endian::big : std::endian::little;
  }

  void read_axes() {
    LabelImage& image = heading_.file.image;
    if (fields_.contains("space directions")) {
      const auto all = numbers_of("space directions", 9);
      for (int k = 0; k < 9; ++k) image.axes(k % 3, k / 3) = all[static_cast<std::size_t>(k)];
      if (fields_.contains("space origin")) {
        const auto origin = numbers_of("space origin", 3);
        image.origin = Point(origin[0], origin[1], origin[2]);
      }
    } else if (fields_.contains("spacings")) {
      const auto spacing = numbers_of("spacings", 3);
      image.axes = Point(spacing[0], spacing[1], spacing[2]).asDiagonal();
    }
    heading_.file.unit = 0.001;
    if (!fields_.contains("space units")) return;
    const std::string units = text_of("space units");
    const auto words = list_words(units);
    const double unit = words.empty() ? 0 : metres_per(words.front());
    if (unit == 0 || std::ranges::count(words, words.front()) != 3)
      fail("space units", "; expected \"mm\" \"mm\" \"mm\", or another unit of all three axes");
    heading_.file.unit = unit, heading_.file.unit_is_said = true;
  }

  // Takes the names that Slicer gives its segments
  void name_segments() {
    for (const auto& [key, value] : keys_) {
      if (!key.starts_with("Segment") || !key.ends_with("_LabelValue")) continue;
      const auto label = integer_in(value.text);
      const auto name = keys_.find(key.substr(0, key.size() - 10) + "Name");
      if (label && *label > 0 && *label < 1'000'000'000 && name != keys_.end())
        heading_.file.image.names[static_cast<int>(*label)] = valid_utf8(name->second.text);
    }
  }

  bool is_text() const {
    const std::string encoding = lower_case(text_of("encoding"));
    return encoding == "ascii" || encoding == "text" || encoding == "txt";
  }

  LabelFile read_voxels() {
    const std::string encoding = lower_case(text_of("encoding"));
    const std::string_view rest = std::string_view(file_.bytes).substr(data_);
    const Place first{0, static_cast<std::int64_t>(data_)};
    if (encoding == "raw") return with_labels(std::move(heading_), file_.name, rest, first);
    if (encoding == "gzip" || encoding == "gz") {
      const std::size_t size = checked_voxels(heading_, file_.name) * bytes_of(heading_.type);
      return with_labels(std::move(heading_), file_.name, inflated(rest, size, file_.name), first);
    }
    if (!is_text()) fail("encoding", "; expected raw, gzip or text");
    TextLines lines(file_, data_, file_.bytes.size(), first_line_);
    TextNumbers numbers(lines, true);
    return with_labels(std::move(heading_), numbers);
  }

  const FileBytes& file_;
  std::map<std::string, Field> fields_, keys_;
  ImageHeading heading_;
  std::size_t data_ = 0;  // first byte after the lines that were read
  std::int64_t first_line_ = 0;
};

}  // namespace

LabelFile parse_nrrd(const FileBytes& file) { return NrrdParser(file).parse(); }

}  // namespace plica
