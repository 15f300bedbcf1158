// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/vtk_grid.hpp>
#include <plica/meshes/files/vtu_arrays.hpp>

namespace plica {

namespace {

class VtuParser {
 public:
  VtuParser(const MemoryFile& file, MeshReport& report) : file_(file), report_(report), arrays_(file) {
    grid_.file = file.name;
  }
  RawMesh parse();

 private:
  void take(const XmlElement& element);
  void data_array(const XmlElement& array, const std::string& section);
  const XmlElement& needed(const std::optional<XmlElement>& array, const char* what) const;
  void read_points();
  void read_cells();
  void read_regions();
  std::vector<PlacedInteger> integers(const XmlElement& array, std::int64_t count, const char* what);
  [[noreturn]] void fail(const Place& place, const std::string& message) const { refuse(file_.name, place, message); }

  const MemoryFile& file_;
  MeshReport& report_;
  VtuArrays arrays_;
  VtkGrid grid_;
  std::optional<XmlElement> root_, piece_, points_, connectivity_, offsets_, types_;
  std::vector<XmlElement> cell_data_;
};

void VtuParser::take(const XmlElement& element) {
  if (element.parent.empty()) {
    if (element.name != "VTKFile") fail(element.place, "expected <VTKFile>, found <" + element.name + ">");
    if (const std::string& type = attribute(element, "type", file_); type != "UnstructuredGrid")
      fail(element.place, "the type of the file is " + shown(type) + "; it must be UnstructuredGrid");
    arrays_.header(element);
    root_ = element;
  } else if (element.name == "Piece") {
    if (piece_) fail(element.place, "a second <Piece>; supported is a grid in one piece");
    piece_ = element;
  } else if (element.name == "DataArray") {
    data_array(element, element.parent);
  } else if (element.name == "AppendedData") {
    arrays_.appended(element);
  }
}

void VtuParser::data_array(const XmlElement& array, const std::string& section) {
  const auto name = array.attributes.find("Name");
  std::optional<XmlElement>* slot = nullptr;
  if (section == "Points") slot = &points_;
  if (section == "Cells" && name != array.attributes.end()) {
    if (name->second == "connectivity") slot = &connectivity_;
    if (name->second == "offsets") slot = &offsets_;
    if (name->second == "types") slot = &types_;
  }
  if (slot) {
    if (*slot) fail(array.place, "a second array of <" + section + "> of this name");
    *slot = array;
  }
  if (section == "CellData") cell_data_.push_back(array);
}

const XmlElement& VtuParser::needed(const std::optional<XmlElement>& array, const char* what) const {
  if (!array) fail(piece_ ? piece_->place : root_->place, std::string("there is no ") + what);
  return *array;
}

void VtuParser::read_points() {
  const XmlElement& array = needed(points_, "<DataArray> in <Points>");
  const std::int64_t count = attribute_count(*piece_, "NumberOfPoints", file_);
  if (attribute_count(array, "NumberOfComponents", file_) != 3)
    fail(array.place, "NumberOfComponents is " + shown(array.attributes.at("NumberOfComponents")) + "; it must be 3");
  arrays_.read(array, [&](Numbers& numbers, NumberType type) {
    grid_.read_points(numbers.checked_count(count, "NumberOfPoints", type, 3), type, numbers);
  });
}

std::vector<PlacedInteger> VtuParser::integers(const XmlElement& array, std::int64_t count, const char* what) {
  std::vector<PlacedInteger> values;
  if (!is_integer(vtu_type(array, file_)))
    fail(array.place, "the type of " + std::string(what) + " is " + shown(array.attributes.at("type")) +
                          "; it must be one of integers");
  arrays_.read(array, [&](Numbers& numbers, NumberType type) {
    values =
        read_integers(numbers.checked_count(count, "the number of " + std::string(what), type, 1), type, what, numbers);
  });
  return values;
}

void VtuParser::read_cells() {
  const std::int64_t count = attribute_count(*piece_, "NumberOfCells", file_);
  grid_.ends = integers(needed(offsets_, "array 'offsets' in <Cells>"), count, "offsets");
  grid_.types = integers(needed(types_, "array 'types' in <Cells>"), count, "types");
  const std::int64_t corners = grid_.ends.empty() ? 0 : grid_.ends.back().value;
  grid_.connectivity = integers(needed(connectivity_, "array 'connectivity' in <Cells>"), corners, "points of cells");
}

void VtuParser::read_regions() {
  const std::int64_t cells = attribute_count(*piece_, "NumberOfCells", file_);
  for (const XmlElement& array : cell_data_) {
    const auto name = array.attributes.find("Name"), components = array.attributes.find("NumberOfComponents");
    const std::string called = name == array.attributes.end() ? "" : name->second;
    const bool single = components == array.attributes.end() || components->second == "1";
    if (called != "region" && (!single || attribute(array, "type", file_).find("Int") == std::string::npos)) continue;
    arrays_.read(array, [&](Numbers& numbers, NumberType type) {
      const std::int64_t width = single ? 1 : attribute_count(array, "NumberOfComponents", file_);
      numbers.checked_count(cells, "NumberOfCells", type, std::max<std::int64_t>(width, 1));
      grid_.read_cell_data(called, cells, width, type, numbers);
    });
  }
}

RawMesh VtuParser::parse() {
  for (const XmlElement& element : vtu_elements(file_)) take(element);
  if (!piece_) fail(root_->place, "there is no <Piece>");
  report_.format = "VTU";
  read_points();
  read_cells();
  read_regions();
  report_.format += ", " + points_->attributes.at("format");
  return grid_.mesh(report_);
}

}  // namespace

RawMesh parse_vtu(const MemoryFile& file, MeshReport& report) { return VtuParser(file, report).parse(); }

}  // namespace plica
