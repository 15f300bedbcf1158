// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <optional>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/vtk_grid.hpp>
#include <plica/meshes/files/vtu_arrays.hpp>

namespace plica {

namespace {

class VtuParser {
 public:
  VtuParser(const FileBytes& file, MeshReport& report)
      : file_(file), report_(report), arrays_(file) {
    grid_.file = file.name;
  }
  ParsedMesh parse();

 private:
  void take(const XmlElement& element);
  void data_array(const XmlElement& array, const std::string& section);
  const XmlElement& needed(const std::string& section, const std::string& name) const;
  void read_points();
  void read_cells();
  void read_polygons();
  void read_numbers();
  void read_vectors();
  std::vector<PlacedInteger> integers(const std::string& section, const char* name,
                                      std::int64_t count);
  std::vector<PlacedInteger> corners(const std::string& section,
                                     const std::vector<PlacedInteger>& ends);
  [[noreturn]] void fail(const Place& place, const std::string& message) const {
    refuse(file_.name, place, message);
  }

  const FileBytes& file_;
  MeshReport& report_;
  VtuArrays arrays_;
  VtkGrid grid_;
  bool polygonal_ = false;
  std::optional<XmlElement> root_, piece_;
  std::map<std::pair<std::string, std::string>, XmlElement> used_;  // arrays by section and name
  std::vector<XmlElement> cell_data_, point_data_;
};

// Section of cells in polygonal data, with the VTK type of the cells
struct Section {
  const char *name, *count;
  int type;
};
constexpr Section polygonal_sections[] = {{"Verts", "NumberOfVerts", 2},
                                          {"Lines", "NumberOfLines", 4},
                                          {"Polys", "NumberOfPolys", 7},
                                          {"Strips", "NumberOfStrips", 6}};

void VtuParser::take(const XmlElement& element) {
  if (element.parent.empty()) {
    if (element.name != "VTKFile")
      fail(element.place, "expected <VTKFile>, found <" + element.name + ">");
    const std::string& type = attribute(element, "type", file_);
    polygonal_ = type == "PolyData";
    if (!polygonal_ && type != "UnstructuredGrid")
      fail(element.place,
           "the type of the file is " + shown(type) + "; it must be UnstructuredGrid or PolyData");
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
  if (section == "CellData") cell_data_.push_back(array);
  if (section == "PointData") point_data_.push_back(array);
  const bool of_cells =
      section == "Cells" ||
      std::ranges::any_of(polygonal_sections, [&](const Section& s) { return section == s.name; });
  if (section != "Points" && !of_cells) return;
  const auto named = array.attributes.find("Name");
  const std::string name =
      section == "Points" || named == array.attributes.end() ? "" : named->second;
  const bool used =
      section == "Points" || name == "connectivity" || name == "offsets" || name == "types";
  if (used && !used_.try_emplace({section, name}, array).second)
    fail(array.place, "a second array of <" + section + "> of this name");
}

const XmlElement& VtuParser::needed(const std::string& section, const std::string& name) const {
  const auto found = used_.find({section, name});
  if (found == used_.end())
    fail(piece_->place, "there is no " + (name.empty() ? "<DataArray>" : "array '" + name + "'") +
                            " in <" + section + ">");
  return found->second;
}

void VtuParser::read_points() {
  const XmlElement& array = needed("Points", "");
  const std::int64_t count = attribute_count(*piece_, "NumberOfPoints", file_);
  if (attribute_count(array, "NumberOfComponents", file_) != 3)
    fail(array.place, "NumberOfComponents is " + shown(array.attributes.at("NumberOfComponents")) +
                          "; it must be 3");
  arrays_.read(array, [&](Numbers& numbers, NumberType type) {
    grid_.read_points(numbers.checked_count(count, "NumberOfPoints", type, 3), type, numbers);
  });
}

std::vector<PlacedInteger> VtuParser::integers(const std::string& section, const char* name,
                                               std::int64_t count) {
  const XmlElement& array = needed(section, name);
  if (!is_integer(vtu_type(array, file_)))
    fail(array.place, "the type of " + std::string(name) + " is " +
                          shown(array.attributes.at("type")) + "; it must be one of integers");
  std::vector<PlacedInteger> values;
  arrays_.read(array, [&](Numbers& numbers, NumberType type) {
    values =
        read_integers(numbers.checked_count(count, "the number of " + std::string(name), type, 1),
                      type, name, numbers);
  });
  return values;
}

std::vector<PlacedInteger> VtuParser::corners(const std::string& section,
                                              const std::vector<PlacedInteger>& ends) {
  return integers(section, "connectivity", ends.empty() ? 0 : ends.back().value);
}

void VtuParser::read_cells() {
  const std::int64_t count = attribute_count(*piece_, "NumberOfCells", file_);
  grid_.ends = integers("Cells", "offsets", count);
  grid_.types = integers("Cells", "types", count);
  grid_.connectivity = corners("Cells", grid_.ends);
}

void VtuParser::read_polygons() {
  for (const Section& section : polygonal_sections) {
    if (!piece_->attributes.contains(section.count)) continue;
    const std::int64_t count = attribute_count(*piece_, section.count, file_);
    if (count == 0) continue;
    const auto ends = integers(section.name, "offsets", count);
    grid_.add_cells(section.type, corners(section.name, ends), ends);
  }
}

// Reads the arrays with one number per cell; that of name "region" must be one
void VtuParser::read_numbers() {
  const std::int64_t cells = attribute_count(*piece_, "NumberOfCells", file_);
  for (const XmlElement& array : cell_data_) {
    const auto name = array.attributes.find("Name"),
               components = array.attributes.find("NumberOfComponents");
    const std::string called = name == array.attributes.end() ? "" : name->second;
    const bool single = components == array.attributes.end() || components->second == "1";
    const std::string& kind = attribute(array, "type", file_);
    const bool numeric = kind.find("Int") != std::string::npos || kind.starts_with("Float");
    if (called != "region" && (!single || !numeric || called.empty())) continue;
    arrays_.read(array, [&](Numbers& numbers, NumberType type) {
      const std::int64_t width = single ? 1 : attribute_count(array, "NumberOfComponents", file_);
      numbers.checked_count(cells, "NumberOfCells", type, std::max<std::int64_t>(width, 1));
      grid_.read_cell_data(called, cells, width, type, numbers);
    });
  }
}

void VtuParser::read_vectors() {
  const auto read = [&](const std::vector<XmlElement>& arrays, const char* count_name,
                        bool of_points) {
    const std::int64_t count = attribute_count(*piece_, count_name, file_);
    for (const XmlElement& array : arrays) {
      const auto name = array.attributes.find("Name"),
                 components = array.attributes.find("NumberOfComponents");
      if (name == array.attributes.end() || components == array.attributes.end() ||
          components->second != "3")
        continue;
      if (name->second == "region" || is_integer(vtu_type(array, file_))) continue;
      arrays_.read(array, [&](Numbers& numbers, NumberType type) {
        numbers.checked_count(count, count_name, type, 3);
        if (of_points)
          grid_.read_point_data(name->second, count, 3, type, numbers);
        else
          grid_.read_cell_data(name->second, count, 3, type, numbers);
      });
    }
  };
  read(cell_data_, "NumberOfCells", false);
  read(point_data_, "NumberOfPoints", true);
}

ParsedMesh VtuParser::parse() {
  for (const XmlElement& element : vtu_elements(file_)) take(element);
  if (!piece_) fail(root_->place, "there is no <Piece>");
  read_points();
  if (polygonal_) {
    read_polygons();
  } else {
    read_cells();
    read_numbers();
    read_vectors();
  }
  report_.format = (polygonal_ ? "VTP, " : "VTU, ") + needed("Points", "").attributes.at("format");
  return grid_.mesh(report_);
}

}  // namespace

ParsedMesh parse_vtu(const FileBytes& file, MeshReport& report) {
  return VtuParser(file, report).parse();
}

}  // namespace plica
