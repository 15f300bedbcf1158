// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/frames.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/meshes/files/vtu_out.hpp>

namespace plica::app {

namespace {

std::string cells(const VtuGrid& grid, VtuOut& vtu) {
  constexpr std::uint8_t vtk_triangle = 5, vtk_tetra = 10;
  const std::size_t size = static_cast<std::size_t>(grid.vertices_per_cell),
                    count = grid.connectivity.size() / size;
  std::vector<int> offsets(count);
  for (std::size_t i = 0; i < count; ++i) offsets[i] = static_cast<int>((i + 1) * size);
  const std::vector<std::uint8_t> types(count, size == 3 ? vtk_triangle : vtk_tetra);
  std::string tags = vtu.add("connectivity", 1, grid.connectivity);
  tags += vtu.add("offsets", 1, offsets);
  return tags += vtu.add("types", 1, types);
}

}  // namespace

std::string vtu_text(const VtuGrid& grid) {
  VtuOut vtu;
  std::string point_data, cell_data;
  for (const auto& [name, values] : grid.point_fields) point_data += vtu.add(name, values);
  for (const auto& [name, values, components] : grid.point_scalars)
    point_data += vtu.add(name, components, values);
  for (const auto& [name, values, components] : grid.cell_scalars)
    cell_data += vtu.add(name, components, values);
  for (const auto& [name, values] : grid.cell_vectors) cell_data += vtu.add(name, values);
  for (const auto& [name, values] : grid.cell_fields) cell_data += vtu.add(name, 1, values);
  const std::string points = vtu.add("Points", grid.points), cell_arrays = cells(grid, vtu);
  return vtu.file(fmt::format(
      "<FieldData>\n"
      "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
      "{:.17g}</DataArray>\n"
      "</FieldData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
      "<PointData>\n{}</PointData>\n<CellData>\n{}</CellData>\n"
      "<Points>\n{}</Points>\n<Cells>\n{}</Cells>\n"
      "</Piece>\n",
      grid.time, grid.points.size(),
      grid.connectivity.size() / static_cast<std::size_t>(grid.vertices_per_cell), point_data,
      cell_data, points, cell_arrays));
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
