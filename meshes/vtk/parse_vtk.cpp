// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/vtk/legacy_arrays.hpp>
#include <plica/meshes/vtk/parse_vtk.hpp>
#include <plica/meshes/vtk/vtk_grid.hpp>
#include <set>

namespace plica {

namespace {

class VtkParser {
 public:
  VtkParser(const MemoryFile& file, MeshReport& report) : lines_(file), report_(report) { grid_.file = file.name; }
  RawMesh parse();

 private:
  using Section = void (VtkParser::*)();

  void header();
  void section();
  void dataset();
  void points();
  void cells();
  void cells_before_5(std::int64_t count, std::int64_t size);
  void cells_of_5(std::int64_t ends, std::int64_t size);
  std::vector<PlacedInteger> integers(const char* heading, std::int64_t count, const char* what);
  void cell_types();
  void cell_data() { data(grid_.ends.size(), true); }
  void point_data() { data(grid_.points.size(), false); }
  void data(std::size_t count, bool of_cells);
  void field() { arrays_.field(lines_); }
  void metadata() { skip_vtk_metadata(lines_); }

  TextLines lines_;
  MeshReport& report_;
  VtkGrid grid_;
  LegacyArrays arrays_{grid_};
  bool version5_ = false;
  std::set<std::string> seen_;
};

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
      {"field", &VtkParser::field},         {"metadata", &VtkParser::metadata}};
  const std::string name = lower_case(lines_.words().front());
  const auto found = known.find(name);
  if (found == known.end()) {
    if (!arrays_.attribute(name, lines_)) lines_.expected("a keyword of an unstructured grid, like POINTS");
    return;
  }
  if (name != "field" && name != "metadata" && !seen_.insert(name).second)
    lines_.fail("a second section " + shown(lines_.words().front()));
  if (!seen_.contains("dataset") && name != "field" && name != "metadata") lines_.expected("DATASET UNSTRUCTURED_GRID");
  (this->*found->second)();
}

void VtkParser::dataset() {
  if (lines_.words().size() != 2 || lower_case(lines_.words()[1]) != "unstructured_grid")
    lines_.expected("DATASET UNSTRUCTURED_GRID");
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
  if (lines_.words().size() != 3) lines_.expected("a line like CELLS 2 10");
  const std::int64_t count = lines_.integer(1, "the number of cells"),
                     size = lines_.integer(2, "the size of the cells");
  version5_ ? cells_of_5(count, size) : cells_before_5(count, size);
}

// Cell after cell the number of its points and these
void VtkParser::cells_before_5(std::int64_t count, std::int64_t size) {
  constexpr NumberType type = NumberType::int32;
  arrays_.form.after(lines_, [&](Numbers& numbers) {
    numbers.checked_count(count, "the number of cells", type, 1);
    numbers.checked_count(size, "the size of the cells", type, 1);
    std::int64_t left = size;
    for (std::int64_t c = 0; c < count; ++c) {
      const std::int64_t points = numbers.integer(type, "the number of points of a cell");
      if (points < 0 || points >= left)
        numbers.fail("the number of points of cell " + std::to_string(c) + " is " + std::to_string(points) +
                     ", but the cells have " + std::to_string(left) + " of " + std::to_string(size) + " numbers left");
      left -= points + 1;
      for (std::int64_t k = 0; k < points; ++k) {
        const std::int64_t point = numbers.integer(type, "a point of a cell");
        grid_.connectivity.push_back({point, numbers.place()});
      }
      grid_.ends.push_back({static_cast<std::int64_t>(grid_.connectivity.size()), numbers.place()});
    }
    if (left != 0)
      numbers.fail("the cells take " + std::to_string(size - left) + " numbers and not " + std::to_string(size));
    return numbers.end("the cells"), 0;
  });
}

std::vector<PlacedInteger> VtkParser::integers(const char* heading, std::int64_t count, const char* what) {
  if (!lines_.next() || lines_.words().size() != 2 || lower_case(lines_.words()[0]) != lower_case(heading))
    lines_.expected(std::string("a line like ") + heading + " vtktypeint64");
  const NumberType type = legacy_vtk_type(1, lines_);
  if (!is_integer(type)) lines_.fail("the type of " + std::string(what) + " is no integer: " + shown(lines_.text()));
  return arrays_.form.after(lines_, [&](Numbers& numbers) {
    numbers.checked_count(count, "the number of values of " + std::string(heading), type, 1);
    auto values = read_integers(count, type, what, numbers);
    numbers.end(heading);
    return values;
  });
}

// Where each cell starts, with the end of the last one, and the points of all
void VtkParser::cells_of_5(std::int64_t offsets, std::int64_t size) {
  grid_.ends = integers("OFFSETS", offsets, "an offset");
  if (!grid_.ends.empty()) {
    if (grid_.ends.front().value != 0)
      refuse(grid_.file, grid_.ends.front().place,
             "the first offset is " + std::to_string(grid_.ends.front().value) + "; it must be 0");
    grid_.ends.erase(grid_.ends.begin());
  }
  grid_.connectivity = integers("CONNECTIVITY", size, "a point of a cell");
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
    if (!seen_.contains(name)) lines_.fail(shown(lines_.text()) + " must come after the points and cells");
  const std::int64_t tuples = lines_.integer(1, "the number of values");
  if (tuples != static_cast<std::int64_t>(count))
    lines_.fail("the number of values is " + std::to_string(tuples) + " for " + std::to_string(count) +
                (of_cells ? " cells" : " points"));
  arrays_.begin(tuples, of_cells);
}

RawMesh VtkParser::parse() {
  header();
  while (lines_.next()) section();
  for (const char* name : {"DATASET", "POINTS", "CELLS", "CELL_TYPES"})
    if (!seen_.contains(lower_case(name))) lines_.expected(name);
  return grid_.mesh(report_);
}

}  // namespace

RawMesh parse_vtk(const MemoryFile& file, MeshReport& report) { return VtkParser(file, report).parse(); }

}  // namespace plica
