// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>
#include <plica/meshes/files/vtk_grid.hpp>
#include <set>
#include <string>

namespace plica {

namespace {

/// Returns the type of numbers that a word of the line names, in any case of letters. Throws an
/// InputError with the choices if there is none.
NumberType legacy_vtk_type(std::size_t word, const TextLines& lines);

/// Skips a block of METADATA, which ends with a blank line.
void skip_vtk_metadata(TextLines& lines);

/// Reader of the arrays of points and cells in VTK's legacy format. They are passed to the grid.
class LegacyArrays {
 public:
  explicit LegacyArrays(VtkGrid& grid) : grid_(grid) {}

  /// Form of the numbers; binary data are big-endian on every machine
  NumberForm form = {false, std::endian::big, true};

  /// Begins the arrays of cells or points, with a number of tuples.
  void begin(std::int64_t tuples, bool of_cells) {
    tuples_ = tuples, of_cells_ = of_cells, begun_ = true;
  }
  /// Reads FIELD: arrays, each with a heading "name components tuples type".
  void field(TextLines& lines);
  /// Reads an array with a keyword such as SCALARS; returns false if the line is not its heading.
  bool attribute(const std::string& keyword, TextLines& lines);

 private:
  void values(const std::string& name, std::int64_t tuples, std::int64_t components,
              NumberType type, TextLines& lines);

  VtkGrid& grid_;
  std::int64_t tuples_ = 0;
  bool of_cells_ = false, begun_ = false;
};

struct TypeName {
  const char* name;
  NumberType type;
};
constexpr TypeName type_names[] = {
    {"unsigned_char", NumberType::uint8},   {"char", NumberType::int8},
    {"unsigned_short", NumberType::uint16}, {"short", NumberType::int16},
    {"unsigned_int", NumberType::uint32},   {"int", NumberType::int32},
    {"unsigned_long", NumberType::uint64},  {"long", NumberType::int64},
    {"vtktypeuint64", NumberType::uint64},  {"vtktypeint64", NumberType::int64},
    {"vtkidtype", NumberType::int32},       {"float", NumberType::float32},
    {"double", NumberType::float64},        {"signed_char", NumberType::int8},
};

// Array with a heading "KEYWORD name type", or with its components in the heading
struct Attribute {
  const char* keyword;
  std::int64_t components;  // 0: given by the word components_word of the heading, else 1
  std::size_t type_word, components_word;
};
constexpr Attribute attributes[] = {
    {"scalars", 0, 2, 3},    {"vectors", 3, 2, 0},    {"normals", 3, 2, 0},
    {"tensors", 9, 2, 0},    {"tensors6", 6, 2, 0},   {"texture_coordinates", 0, 3, 2},
    {"global_ids", 1, 2, 0}, {"edge_flags", 1, 2, 0}, {"pedigree_ids", 1, 2, 0},
};

constexpr std::int64_t most_components = 1'000'000;

std::int64_t read_components(std::size_t word, const TextLines& lines) {
  const std::int64_t components = lines.integer(word, "the number of components");
  if (components < 1 || components > most_components)
    lines.fail("the number of components is " + std::to_string(components) + "; it must be 1 to " +
               std::to_string(most_components));
  return components;
}

NumberType legacy_vtk_type(std::size_t word, const TextLines& lines) {
  if (word >= lines.words().size()) lines.expected("a type of numbers");
  const std::string name = lower_case(lines.words()[word]);
  std::vector<std::string> choices;
  for (const TypeName& known : type_names) {
    if (name == known.name) return known.type;
    choices.emplace_back(known.name);
  }
  lines.fail(unknown_name("type of numbers", printable(name), choices));
}

void skip_vtk_metadata(TextLines& lines) {
  while (lines.next_or_blank())
    if (lines.words().empty()) return;
}

void LegacyArrays::values(const std::string& name, std::int64_t tuples, std::int64_t components,
                          NumberType type, TextLines& lines) {
  form.after(lines, [&](Numbers& numbers) {
    numbers.checked_count(tuples, "the number of values of " + shown(name), type, components);
    if (of_cells_)
      grid_.read_cell_data(name, tuples, components, type, numbers);
    else
      grid_.read_point_data(name, tuples, components, type, numbers);
    return numbers.end("the values of " + shown(name)), 0;
  });
}

void LegacyArrays::field(TextLines& lines) {
  const std::int64_t arrays = lines.integer(2, "the number of arrays");
  for (std::int64_t i = 1; i <= arrays; ++i) {
    bool found = lines.next();
    if (found && lower_case(lines.words()[0]) == "metadata")
      skip_vtk_metadata(lines), found = lines.next();
    if (!found || lines.words().size() != 4)
      lines.expected("array " + std::to_string(i) + " of " + std::to_string(arrays) +
                     ", a line like region 1 8 int");
    const std::string name(lines.words()[0]);
    const std::int64_t components = read_components(1, lines);
    values(name, lines.integer(2, "the number of tuples"), components, legacy_vtk_type(3, lines),
           lines);
  }
}

bool LegacyArrays::attribute(const std::string& keyword, TextLines& lines) {
  if (!begun_) return false;
  const std::size_t words = lines.words().size();
  const std::string name = words > 1 ? std::string(lines.words()[1]) : "";
  // Colours are bytes in binary and real numbers in text. A table of colours has a section of its
  // own.
  const NumberType colour = form.binary ? NumberType::uint8 : NumberType::float32;
  if (keyword == "color_scalars")
    return values(name, tuples_, read_components(2, lines), colour, lines), true;
  if (keyword == "lookup_table")
    return values("", lines.integer(2, "the size of a table"), 4, colour, lines), true;
  for (const Attribute& known : attributes) {
    if (keyword != known.keyword) continue;
    const bool told = known.components == 0 && known.components_word < words;
    const std::int64_t components =
        told ? read_components(known.components_word, lines) : known.components;
    const NumberType type = legacy_vtk_type(known.type_word, lines);
    if (keyword == "scalars" && (!lines.next() || lower_case(lines.words()[0]) != "lookup_table"))
      lines.expected("a line like LOOKUP_TABLE default");
    values(name, tuples_, std::max<std::int64_t>(components, 1), type, lines);
    return true;
  }
  return false;
}

class VtkParser {
 public:
  VtkParser(const FileBytes& file, MeshReport& report) : lines_(file), report_(report) {
    grid_.file = file.name;
  }
  ParsedMesh parse();

 private:
  using Section = void (VtkParser::*)();

  void header();
  void section();
  void dataset();
  void points();
  void cells();
  void cells_of(int type);
  void read_cells(const char* line);
  void cells_before_5(std::int64_t count, std::int64_t size);
  void cells_of_5(std::int64_t ends, std::int64_t size);
  std::vector<PlacedInteger> integers(const char* heading, std::int64_t count, const char* what);
  void cell_types();
  void vertices() { cells_of(2); }
  void lines() { cells_of(4); }
  void polygons() { cells_of(7); }
  void strips() { cells_of(6); }
  void cell_data() { data(grid_.ends.size(), true); }
  void point_data() { data(grid_.points.size(), false); }
  void data(std::size_t count, bool of_cells);
  void field() { arrays_.field(lines_); }
  void metadata() { skip_vtk_metadata(lines_); }

  TextLines lines_;
  MeshReport& report_;
  VtkGrid grid_;
  LegacyArrays arrays_{grid_};
  bool version5_ = false, polygonal_ = false;
  std::vector<PlacedInteger> corners_, ends_;  // points and ends of the last section of cells
  std::set<std::string> seen_;
};

constexpr const char* dataset_line = "DATASET UNSTRUCTURED_GRID, or POLYDATA";

void VtkParser::header() {
  constexpr std::string_view start = "# vtk DataFile Version ";
  if (!lines_.next_or_blank() || !lines_.text().starts_with(start))
    lines_.expected("# vtk DataFile Version, the start of a VTK file");
  const std::string_view version = lines_.text().substr(start.size());
  constexpr std::string_view known[] = {"1.0", "2.0", "3.0", "4.0", "4.1", "4.2", "5.0", "5.1"};
  if (std::find(std::begin(known), std::end(known), version) == std::end(known))
    lines_.fail("the version is " + shown(version) + "; supported are 1.0 to 5.1");
  version5_ = version.front() == '5';
  if (!lines_.next_or_blank()) lines_.expected("a title");
  const bool is_binary = lines_.next() && lower_case(lines_.text()) == "binary";
  if (!is_binary && lower_case(lines_.text()) != "ascii") lines_.expected("ASCII or BINARY");
  arrays_.form.binary = is_binary;
  report_.format = "VTK legacy " + std::string(version) + (is_binary ? " binary" : " ASCII");
}

void VtkParser::section() {
  static const std::map<std::string, Section> known = {
      {"dataset", &VtkParser::dataset},     {"points", &VtkParser::points},
      {"cells", &VtkParser::cells},         {"cell_types", &VtkParser::cell_types},
      {"cell_data", &VtkParser::cell_data}, {"point_data", &VtkParser::point_data},
      {"vertices", &VtkParser::vertices},   {"lines", &VtkParser::lines},
      {"polygons", &VtkParser::polygons},   {"triangle_strips", &VtkParser::strips},
      {"field", &VtkParser::field},         {"metadata", &VtkParser::metadata}};
  const std::string name = lower_case(lines_.words().front());
  const auto found = known.find(name);
  if (found == known.end()) {
    if (!arrays_.attribute(name, lines_)) lines_.expected("a keyword of a grid, like POINTS");
    return;
  }
  if (name != "field" && name != "metadata" && !seen_.insert(name).second)
    lines_.fail("a second section " + shown(lines_.words().front()));
  if (!seen_.contains("dataset") && name != "field" && name != "metadata")
    lines_.expected(dataset_line);
  (this->*found->second)();
}

void VtkParser::dataset() {
  const std::string kind = lines_.words().size() == 2 ? lower_case(lines_.words()[1]) : "";
  polygonal_ = kind == "polydata";
  if (!polygonal_ && kind != "unstructured_grid") lines_.expected(dataset_line);
}

void VtkParser::points() {
  if (lines_.words().size() != 3) lines_.expected("a line like POINTS 8 double");
  const NumberType type = legacy_vtk_type(2, lines_);
  const std::int64_t count = lines_.integer(1, "the number of points");
  arrays_.form.after(lines_, [&](Numbers& numbers) {
    grid_.read_points(numbers.checked_count(count, "the number of points", type, 3), type, numbers);
    return numbers.end("the points"), 0;
  });
}

void VtkParser::cells() {
  if (polygonal_) lines_.expected("POLYGONS or another keyword of POLYDATA");
  read_cells("a line like CELLS 2 10");
  grid_.connectivity = std::move(corners_), grid_.ends = std::move(ends_);
}

// Reads a section of polygonal data, with cells of one type
void VtkParser::cells_of(int type) {
  if (!polygonal_) lines_.expected("CELLS or another keyword of UNSTRUCTURED_GRID");
  read_cells("a line like POLYGONS 2 10");
  grid_.add_cells(type, corners_, ends_);
}

void VtkParser::read_cells(const char* line) {
  if (lines_.words().size() != 3) lines_.expected(line);
  corners_.clear(), ends_.clear();
  const std::int64_t count = lines_.integer(1, "the number of cells"),
                     size = lines_.integer(2, "the size of the cells");
  version5_ ? cells_of_5(count, size) : cells_before_5(count, size);
}

// Reads the cells of versions before 5: for each cell the number of its points, then the points
void VtkParser::cells_before_5(std::int64_t count, std::int64_t size) {
  constexpr NumberType type = NumberType::int32;
  arrays_.form.after(lines_, [&](Numbers& numbers) {
    numbers.checked_count(count, "the number of cells", type, 1);
    numbers.checked_count(size, "the size of the cells", type, 1);
    std::int64_t left = size;
    for (std::int64_t c = 0; c < count; ++c) {
      const std::int64_t points = numbers.integer(type, "the number of points of a cell");
      if (points < 0 || points >= left)
        numbers.fail("the number of points of cell " + std::to_string(c) + " is " +
                     std::to_string(points) + ", but the cells have " + std::to_string(left) +
                     " of " + std::to_string(size) + " numbers left");
      left -= points + 1;
      for (std::int64_t k = 0; k < points; ++k) {
        const std::int64_t point = numbers.integer(type, "a point of a cell");
        corners_.push_back({point, numbers.place()});
      }
      ends_.push_back({static_cast<std::int64_t>(corners_.size()), numbers.place()});
    }
    if (left != 0)
      numbers.fail("the cells take " + std::to_string(size - left) + " numbers and not " +
                   std::to_string(size));
    return numbers.end("the cells"), 0;
  });
}

std::vector<PlacedInteger> VtkParser::integers(const char* heading, std::int64_t count,
                                               const char* what) {
  if (!lines_.next() || lines_.words().size() != 2 ||
      lower_case(lines_.words()[0]) != lower_case(heading))
    lines_.expected(std::string("a line like ") + heading + " vtktypeint64");
  const NumberType type = legacy_vtk_type(1, lines_);
  if (!is_integer(type))
    lines_.fail("the type of " + std::string(what) + " is no integer: " + shown(lines_.text()));
  return arrays_.form.after(lines_, [&](Numbers& numbers) {
    numbers.checked_count(count, "the number of values of " + std::string(heading), type, 1);
    auto values = read_integers(count, type, what, numbers);
    numbers.end(heading);
    return values;
  });
}

// Reads the cells of version 5: the start of each cell and the end of the last one, then the points
// of all cells
void VtkParser::cells_of_5(std::int64_t offsets, std::int64_t size) {
  ends_ = integers("OFFSETS", offsets, "an offset");
  if (!ends_.empty()) {
    if (ends_.front().value != 0)
      refuse(grid_.file, ends_.front().place,
             "the first offset is " + std::to_string(ends_.front().value) + "; it must be 0");
    ends_.erase(ends_.begin());
  }
  corners_ = integers("CONNECTIVITY", size, "a point of a cell");
}

void VtkParser::cell_types() {
  if (lines_.words().size() != 2) lines_.expected("a line like CELL_TYPES 2");
  const std::int64_t count = lines_.integer(1, "the number of types");
  constexpr NumberType type = NumberType::int32;
  arrays_.form.after(lines_, [&](Numbers& numbers) {
    numbers.checked_count(count, "the number of types", type, 1);
    grid_.types = read_integers(count, type, "the type of a cell", numbers);
    return numbers.end("the types"), 0;
  });
}

void VtkParser::data(std::size_t count, bool of_cells) {
  for (const char* name : {"points", "cells"})
    if (!polygonal_ && !seen_.contains(name))
      lines_.fail(shown(lines_.text()) + " must come after the points and cells");
  const std::int64_t tuples = lines_.integer(1, "the number of values");
  if (tuples != static_cast<std::int64_t>(count))
    lines_.fail("the number of values is " + std::to_string(tuples) + " for " +
                std::to_string(count) + (of_cells ? " cells" : " points"));
  arrays_.begin(tuples, of_cells);
}

ParsedMesh VtkParser::parse() {
  header();
  while (lines_.next()) section();
  for (const char* name : {"DATASET", "POINTS", "CELLS", "CELL_TYPES"})
    if (!(polygonal_ && name[0] == 'C') && !seen_.contains(lower_case(name))) lines_.expected(name);
  return grid_.mesh(report_);
}

}  // namespace

ParsedMesh parse_vtk(const FileBytes& file, MeshReport& report) {
  return VtkParser(file, report).parse();
}

}  // namespace plica
