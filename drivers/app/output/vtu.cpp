// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <plica/drivers/app/output/vtu.hpp>

namespace plica::app {
namespace {

// The numbers at the end of the file: each array is preceded by its length in bytes, and found by its offset
class Appended {
 public:
  template <class T>
  std::string array(const char* type, const std::string& name, int components, const std::vector<T>& values) {
    const std::size_t offset = bytes_.size();
    const std::uint64_t size = values.size() * sizeof(T);
    add(&size, sizeof(size));
    add(values.data(), size);
    return fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        type, name, components, offset);
  }
  std::string points(const std::string& name, const std::vector<Point>& values) {
    std::vector<double> numbers;
    numbers.reserve(3 * values.size());
    for (const Point& p : values) numbers.insert(numbers.end(), {p.x(), p.y(), p.z()});
    return array("Float64", name, 3, numbers);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void add(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string bytes_;
};

std::string cells(const VtuGrid& grid, Appended& appended) {
  constexpr unsigned char vtk_triangle = 5, vtk_tetra = 10;
  const std::size_t size = static_cast<std::size_t>(grid.vertices_per_cell), count = grid.connectivity.size() / size;
  std::vector<std::int32_t> offsets(count);
  for (std::size_t i = 0; i < count; ++i) offsets[i] = static_cast<std::int32_t>((i + 1) * size);
  const std::vector<unsigned char> types(count, size == 3 ? vtk_triangle : vtk_tetra);
  return appended.array("Int32", "connectivity", 1, grid.connectivity) +
         appended.array("Int32", "offsets", 1, offsets) + appended.array("UInt8", "types", 1, types);
}

}  // namespace

std::string vtu_text(const VtuGrid& grid) {
  static_assert(sizeof(int) == sizeof(std::int32_t));
  Appended appended;
  std::string point_data, cell_data;
  for (const auto& [name, values] : grid.point_fields) point_data += appended.points(name, values);
  for (const auto& [name, values] : grid.point_scalars) point_data += appended.array("Float64", name, 1, values);
  for (const auto& [name, values] : grid.cell_scalars) cell_data += appended.array("Float64", name, 1, values);
  for (const auto& [name, values] : grid.cell_fields) cell_data += appended.array("Int32", name, 1, values);
  const std::string points = appended.points("Points", grid.points), cell_arrays = cells(grid, appended);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
      "  <UnstructuredGrid>\n"
      "    <FieldData>\n"
      "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{:.17g}</DataArray>\n"
      "    </FieldData>\n"
      "    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
      "      <PointData>\n{}      </PointData>\n"
      "      <CellData>\n{}      </CellData>\n"
      "      <Points>\n{}      </Points>\n"
      "      <Cells>\n{}      </Cells>\n"
      "    </Piece>\n"
      "  </UnstructuredGrid>\n"
      "  <AppendedData encoding=\"raw\">\n_{}\n  </AppendedData>\n"
      "</VTKFile>\n",
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian", grid.time, grid.points.size(),
      grid.connectivity.size() / static_cast<std::size_t>(grid.vertices_per_cell), point_data, cell_data, points,
      cell_arrays, appended.bytes());
}

}  // namespace plica::app
