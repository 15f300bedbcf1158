// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/frames.hpp>
#include <plica/drivers/app/output/write_file.hpp>

namespace plica::app {

namespace {

// Binary arrays at the end of a .vtu file. Each array is preceded by its length in bytes; its
// header gives its offset
class Appended {
 public:
  template <class T>
  std::string array(const char* type, const std::string& name, int components,
                    const std::vector<T>& values) {
    const std::size_t offset = bytes_.size();
    const std::uint64_t size = values.size() * sizeof(T);
    add(&size, sizeof(size));
    add(values.data(), size);
    return fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
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
  void add(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string bytes_;
};

std::string cells(const VtuGrid& grid, Appended& appended) {
  constexpr unsigned char vtk_triangle = 5, vtk_tetra = 10;
  const std::size_t size = static_cast<std::size_t>(grid.vertices_per_cell),
                    count = grid.connectivity.size() / size;
  std::vector<std::int32_t> offsets(count);
  for (std::size_t i = 0; i < count; ++i) offsets[i] = static_cast<std::int32_t>((i + 1) * size);
  const std::vector<unsigned char> types(count, size == 3 ? vtk_triangle : vtk_tetra);
  return appended.array("Int32", "connectivity", 1, grid.connectivity) +
         appended.array("Int32", "offsets", 1, offsets) +
         appended.array("UInt8", "types", 1, types);
}

}  // namespace

std::string vtu_text(const VtuGrid& grid) {
  static_assert(sizeof(int) == sizeof(std::int32_t));
  Appended appended;
  std::string point_data, cell_data;
  for (const auto& [name, values] : grid.point_fields) point_data += appended.points(name, values);
  for (const auto& [name, values] : grid.point_scalars)
    point_data += appended.array("Float64", name, 1, values);
  for (const auto& [name, values] : grid.cell_scalars)
    cell_data += appended.array("Float64", name, 1, values);
  for (const auto& [name, values] : grid.cell_vectors) cell_data += appended.points(name, values);
  for (const auto& [name, values] : grid.cell_fields)
    cell_data += appended.array("Int32", name, 1, values);
  const std::string points = appended.points("Points", grid.points),
                    cell_arrays = cells(grid, appended);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\">\n"
      "  <UnstructuredGrid>\n"
      "    <FieldData>\n"
      "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{:.17g}</DataArray>\n"
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
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian", grid.time,
      grid.points.size(),
      grid.connectivity.size() / static_cast<std::size_t>(grid.vertices_per_cell), point_data,
      cell_data, points, cell_arrays, appended.bytes());
}

Frames::Frames(std::filesystem::path folder, std::string name, std::string collection,
               const std::vector<double>& times)
    : folder_(std::move(folder)), name_(std::move(name)), collection_(std::move(collection)) {
  make_folder(folder_ / "frames");
  for (const double time : times) {
    if (!std::filesystem::exists(folder_ / file_of(entries_)))
      throw InputError("cannot resume: there is no " + (folder_ / file_of(entries_)).string() +
                       " any more");
    enlist(time);
  }
  remove_others();
  synchronised_ = entries_;
}

void Frames::cut_back(std::size_t count) {
  std::size_t end = 0;
  for (std::size_t i = 0; i < count; ++i) end = list_.find('\n', end) + 1;
  list_.resize(end), entries_ = count, synchronised_ = std::min(synchronised_, count);
  remove_others();
}

std::string Frames::file_of(std::size_t entry) const {
  return fmt::format("frames/{}_{:04}.vtu", name_, entry);
}

void Frames::enlist(double time) {
  list_ += fmt::format("    <DataSet timestep=\"{:.12g}\" part=\"0\" file=\"{}\"/>\n", time,
                       file_of(entries_));
  ++entries_;
}

void Frames::write_collection() const {
  write_file(folder_ / collection_, fmt::format("<?xml version=\"1.0\"?>\n"
                                                "<VTKFile type=\"Collection\" version=\"1.0\">\n"
                                                "  <Collection>\n{}  </Collection>\n"
                                                "</VTKFile>\n",
                                                list_));
}

// Removes files NAME_NUMBER.vtu whose number is not in the list, and unfinished files (.part).
// Rewrites the collection; removes it if the list is empty
void Frames::remove_others() {
  std::error_code ignored;
  if (entries_ == 0)
    std::filesystem::remove(folder_ / collection_, ignored);
  else
    write_collection();
  std::vector<std::filesystem::path> stale;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "frames")) {
    const std::string file = entry.path().filename().string(), start = name_ + "_";
    if (!file.starts_with(start)) continue;
    std::size_t number = 0;
    const auto [rest, error] =
        std::from_chars(file.data() + start.size(), file.data() + file.size(), number);
    const std::string_view ending(rest, static_cast<std::size_t>(file.data() + file.size() - rest));
    if (error == std::errc{} && (ending == ".vtu.part" || (ending == ".vtu" && number >= entries_)))
      stale.push_back(entry.path());
  }
  for (const auto& file : stale) std::filesystem::remove(file, ignored);
}

void Frames::write(const VtuGrid& grid) {
  write_file(folder_ / file_of(entries_), vtu_text(grid));
  enlist(grid.time);
  write_collection();
}

void Frames::sync() {
  if (synchronised_ == entries_) return;
  for (; synchronised_ < entries_; ++synchronised_) sync_file(folder_ / file_of(synchronised_));
  sync_file(folder_ / collection_);
  sync_file(folder_ / "frames");
}

}  // namespace plica::app
