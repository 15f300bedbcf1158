// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/text.hpp>
#include <plica/meshes/files/image_parts.hpp>

namespace plica {

namespace {

struct ImageType {
  std::string_view name;
  NumberType type;
};
constexpr ImageType image_types[] = {
    {"char", NumberType::int8},
    {"signed_char", NumberType::int8},
    {"unsigned_char", NumberType::uint8},
    {"short", NumberType::int16},
    {"unsigned_short", NumberType::uint16},
    {"int", NumberType::int32},
    {"unsigned_int", NumberType::uint32},
    {"long", NumberType::int64},
    {"vtktypeint64", NumberType::int64},
    {"unsigned_long", NumberType::uint64},
    {"float", NumberType::float32},
    {"double", NumberType::float64},
};

// Reads the first array of STRUCTURED_POINTS
class VtkImageParser {
 public:
  explicit VtkImageParser(const FileBytes& file) : lines_(file) {}

  LabelFile parse() {
    read_heading();
    while (lines_.next()) {
      const std::string word = lower_case(lines_.words().front());
      if (word == "dimensions")
        for (std::size_t k = 0; k < 3; ++k) points_[k] = lines_.integer(k + 1, "a dimension");
      else if (word == "origin")
        origin_ = point("a coordinate of the origin");
      else if (word == "spacing" || word == "aspect_ratio")
        spacing_ = point("a spacing");
      else if (word == "point_data" || word == "cell_data")
        of_cells_ = word == "cell_data", values_ = lines_.integer(1, "the number of values");
      else if (word == "scalars")
        return scalars();
      else if (word == "field" && values_ >= 0)
        return first_of_field();
      else
        lines_.expected("DIMENSIONS, ORIGIN, SPACING, POINT_DATA, CELL_DATA, SCALARS or FIELD");
    }
    lines_.expected("SCALARS, the labels");
  }

 private:
  Point point(std::string_view what) const {
    return Point(lines_.number(1, what), lines_.number(2, what), lines_.number(3, what));
  }

  void read_heading() {
    if (!lines_.next() || !lower_case(lines_.text()).starts_with("# vtk datafile version"))
      lines_.expected("# vtk DataFile Version, the start of a file of VTK");
    if (!lines_.next_or_blank() || !lines_.next()) lines_.expected("ASCII or BINARY");
    const std::string form = lower_case(lines_.text());
    if (form != "ascii" && form != "binary") lines_.expected("ASCII or BINARY");
    form_ = {form == "binary", std::endian::big, true};
    if (!lines_.next() || lower_case(lines_.text()) != "dataset structured_points")
      lines_.expected("DATASET STRUCTURED_POINTS, an image");
  }

  LabelFile scalars() {
    const NumberType type = type_of(2);
    if (lines_.words().size() > 3 && lines_.integer(3, "the number of components") != 1)
      lines_.fail("the array has several components; expected a label for each voxel");
    if (!lines_.next() || lower_case(lines_.words().front()) != "lookup_table")
      lines_.expected("LOOKUP_TABLE");
    return labels(type);
  }

  LabelFile first_of_field() {
    if (!lines_.next()) lines_.expected("an array: name, components, count, type");
    const NumberType type = type_of(3);
    if (lines_.integer(1, "the number of components") != 1 ||
        lines_.integer(2, "the number of values") != values_)
      lines_.fail("the first array of the field has " + printable(lines_.text()) +
                  "; expected a label for each voxel");
    return labels(type);
  }

  NumberType type_of(std::size_t word) const {
    const std::string name =
        word < lines_.words().size() ? lower_case(lines_.words()[word]) : std::string();
    const auto found = std::ranges::find(image_types, name, &ImageType::name);
    if (found == std::end(image_types))
      lines_.fail("the type of the array is " + shown(name) + "; expected a number, such as int");
    return found->type;
  }

  LabelFile labels(NumberType type) {
    ImageHeading heading;
    heading.file.format = "VTK legacy, structured points";
    heading.type = type;
    LabelImage& image = heading.file.image;
    image.axes = spacing_.asDiagonal();
    image.origin = of_cells_ ? Point(origin_ + spacing_ / 2) : origin_;
    std::int64_t all = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      heading.size[k] = points_[k] - (of_cells_ ? 1 : 0);
      if (heading.size[k] < 1 || heading.size[k] > 1'000'000)
        lines_.fail(text("DIMENSIONS has ", points_[k], "; expected 1 to 1000000 voxels"));
      all *= heading.size[k];
    }
    if (all != values_) lines_.fail(text("there are ", values_, " values for ", all, " voxels"));
    return form_.after(lines_, [&](Numbers& numbers) { return with_labels(heading, numbers); });
  }

  TextLines lines_;
  NumberForm form_;
  std::array<std::int64_t, 3> points_ = {0, 0, 0};
  Point origin_ = Point::Zero(), spacing_ = Point::Ones();
  bool of_cells_ = false;
  std::int64_t values_ = -1;
};

}  // namespace

LabelFile parse_vtk_image(const FileBytes& file) { return VtkImageParser(file).parse(); }

}  // namespace plica
