// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/vtk_grid.hpp>

namespace plica {

namespace {

constexpr const char* region_name = "region";

// Refuses a grid that does not have one type per cell
void check_types(const VtkGrid& grid) {
  if (grid.types.size() != grid.ends.size())
    refuse(grid.file, grid.types.empty() ? Place{} : grid.types.back().place,
           "there are " + std::to_string(grid.types.size()) + " types for " +
               std::to_string(grid.ends.size()) + " cells");
}

void check_ends(const VtkGrid& grid) {
  std::int64_t start = 0;
  for (std::size_t c = 0; c < grid.ends.size(); start = grid.ends[c++].value)
    if (grid.ends[c].value < start ||
        grid.ends[c].value > static_cast<std::int64_t>(grid.connectivity.size()))
      refuse(grid.file, grid.ends[c].place,
             "cell " + std::to_string(c) + " is from " + std::to_string(start) + " to " +
                 std::to_string(grid.ends[c].value) + " of " +
                 std::to_string(grid.connectivity.size()) + " points of cells");
  if (start != static_cast<std::int64_t>(grid.connectivity.size()))
    refuse(grid.file, grid.ends.empty() ? Place{} : grid.ends.back().place,
           "the cells use " + std::to_string(start) + " of " +
               std::to_string(grid.connectivity.size()) + " points of cells");
}

}  // namespace

std::vector<PlacedInteger> read_integers(std::int64_t count, NumberType type, std::string_view what,
                                         Numbers& numbers) {
  std::vector<PlacedInteger> values;
  values.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t value = numbers.integer(type, what);
    values.push_back({value, numbers.place()});
  }
  return values;
}

void VtkGrid::read_points(std::int64_t count, NumberType type, Numbers& numbers) {
  constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
  points.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    RawVertex vertex;
    vertex.tag = i;
    for (int a = 0; a < 3; ++a) {
      vertex.position[a] = numbers.number(type, what[a]);
      if (a == 0) vertex.place = numbers.place();
    }
    points.push_back(vertex);
  }
}

void VtkGrid::read_vectors(const std::string& name, std::int64_t tuples, NumberType type,
                           bool of_points, Numbers& numbers) {
  RawVectors field{name, of_points, std::vector<Point>(static_cast<std::size_t>(tuples))};
  for (Point& value : field.values)
    for (int k = 0; k < 3; ++k) value[k] = numbers.any_number(type, "a component of a vector");
  vectors.push_back(std::move(field));
}

void VtkGrid::read_point_data(const std::string& name, std::int64_t tuples, std::int64_t components,
                              NumberType type, Numbers& numbers) {
  if (components == 3 && !is_integer(type) && !name.empty())
    return read_vectors(name, tuples, type, true, numbers);
  numbers.skip(tuples * components, type, "a value");
}

void VtkGrid::read_cell_data(const std::string& name, std::int64_t tuples, std::int64_t components,
                             NumberType type, Numbers& numbers) {
  if (components == 3 && !is_integer(type) && !name.empty() && name != region_name)
    return read_vectors(name, tuples, type, false, numbers);
  if (name == region_name && components != 1)
    numbers.fail(
        "the array 'region' of the cells must be one integer per cell, to tell their regions");
  if (components != 1 || name.empty())
    return numbers.skip(tuples * components, type, "a value of the cells");
  RawNumbers array;
  array.name = name;
  const std::string what = "a value of the array " + shown(name);
  for (std::int64_t i = 0; i < tuples; ++i) {
    const double value = numbers.any_number(type, what);
    array.add(value, numbers.place());
  }
  arrays.push_back(std::move(array));
}

void VtkGrid::add_cells(int type, const std::vector<PlacedInteger>& points_of_cells,
                        const std::vector<PlacedInteger>& cell_ends) {
  const auto base = static_cast<std::int64_t>(connectivity.size());
  connectivity.insert(connectivity.end(), points_of_cells.begin(), points_of_cells.end());
  for (const PlacedInteger& end : cell_ends) {
    if (end.value < 0 || end.value > static_cast<std::int64_t>(points_of_cells.size()))
      refuse(file, end.place,
             "a cell ends after " + std::to_string(end.value) + " of " +
                 std::to_string(points_of_cells.size()) + " points of cells");
    ends.push_back({base + end.value, end.place});
    types.push_back({type, end.place});
  }
}

// Adds the triangles of a strip; every second one has the opposite orientation
void VtkGrid::add_strip(std::int64_t tag, std::span<const std::int64_t> corners, const Place& place,
                        ParsedMesh& raw, MeshReport& report) const {
  ++report.other_elements["strip of triangles"];
  for (std::size_t k = 0; k + 2 < corners.size(); ++k) {
    const bool odd = k % 2 == 1;
    add_face(tag, std::array{corners[k], corners[k + (odd ? 2 : 1)], corners[k + (odd ? 1 : 2)]},
             place, raw);
  }
}

ParsedMesh VtkGrid::mesh(MeshReport& report) const {
  constexpr std::int64_t strip = 6, pixel = 8, voxel = 11;
  check_ends(*this);
  check_types(*this);
  ParsedMesh raw;
  raw.file = file;
  raw.vertices = points;
  std::vector<std::int64_t> corners;
  std::vector<std::size_t> cells;  // per tetrahedron its cell
  for (std::size_t c = 0; c < ends.size(); ++c) {
    const std::size_t begin = c == 0 ? 0 : static_cast<std::size_t>(ends[c - 1].value);
    const std::size_t size = static_cast<std::size_t>(ends[c].value) - begin;
    const std::int64_t tag = static_cast<std::int64_t>(c), type = types[c].value;
    const auto who = [&] { return "cell " + std::to_string(c); };
    const Place place = size > 0 ? connectivity[begin].place : types[c].place;
    const ElementKind& kind = taken_kind(vtk_cells, type, who, file, types[c].place);
    if (kind.vertices > 0 ? size != static_cast<std::size_t>(kind.vertices)
                          : size < static_cast<std::size_t>(kind.corners))
      refuse(file, place,
             who() + ", a " + kind.name + ", has " + std::to_string(size) + " points; expected " +
                 (kind.vertices > 0 ? std::to_string(kind.vertices)
                                    : std::to_string(kind.corners) + " or more"));
    corners.clear();
    for (std::size_t k = begin; k < begin + size; ++k) corners.push_back(connectivity[k].value);
    if (type == pixel || type == voxel) std::swap(corners[2], corners[3]);
    if (type == voxel) std::swap(corners[6], corners[7]);
    if (type == strip)
      add_strip(tag, corners, place, raw, report);
    else
      cells.insert(cells.end(), add_element(kind, tag, corners, place, raw, report), c);
  }
  for (const RawNumbers& array : arrays) {
    if (array.wrong.empty() && array.values.size() != ends.size()) continue;
    RawNumbers& taken = raw.numbers.emplace_back(array);
    taken.values.clear();
    for (std::size_t t = 0; array.wrong.empty() && t < cells.size(); ++t)
      taken.values.push_back(array.values[cells[t]]);
    taken.name_of = [name = array.name](std::int64_t number) {
      return name + "_" + std::to_string(number);
    };
  }
  // Vectors of another count belong to the file as a whole, and are left out
  for (const bool of_points : {false, true})
    for (const RawVectors& field : vectors)
      if (field.of_vertices == of_points &&
          field.values.size() == (of_points ? points.size() : ends.size()))
        raw.vectors.push_back(field);
  return raw;
}

}  // namespace plica
