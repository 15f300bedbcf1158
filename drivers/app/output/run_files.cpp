// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/meshes/boundary_triangles.hpp>

namespace plica::app {
namespace {

std::vector<Point> displacements(const std::vector<Point>& positions, const std::vector<Point>& rest,
                                 const Point& placement) {
  std::vector<Point> result(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) result[i] = positions[i] - rest[i] - placement;
  return result;
}

Point placement_of(const Body& body) {
  if (!body.initial.position) return Point::Zero();
  const Box box = bounding_box(body.levels.front().vertices);
  return *body.initial.position - (box.min + box.max) / 2;
}

std::vector<Point> gathered(const std::vector<Point>& values, const std::vector<int>& indices) {
  std::vector<Point> result;
  result.reserve(indices.size());
  for (const int i : indices) result.push_back(values[static_cast<std::size_t>(i)]);
  return result;
}

template <std::size_t N>
std::vector<int> flat(const std::vector<std::array<int, N>>& cells) {
  std::vector<int> result;
  result.reserve(N * cells.size());
  for (const auto& cell : cells) result.insert(result.end(), cell.begin(), cell.end());
  return result;
}

}  // namespace

RunFiles::RunFiles(const Scene& scene, const std::filesystem::path& folder)
    : numbering_(scene.numbering.front()),
      finest_(in_input_order(scene.problem.body.levels.front(), numbering_)),
      placement_(placement_of(scene.problem.body)),
      surface_frames_(folder, "surface", "frames.pvd"),
      history_(folder / "history.csv", vertex_masses(scene.problem.body)) {
  std::error_code ignored;
  std::filesystem::remove(folder / "summary.json", ignored);
  Frames volume(folder, "volume", "volume.pvd");
  if (scene.output.volume) volume_frames_ = std::move(volume);
  if (scene.problem.body.surface) {
    skin_ = *scene.problem.body.surface;
  } else {
    BoundarySurface boundary = boundary_surface(finest_);
    skin_ = std::move(boundary.surface);
    skin_vertex_ = std::move(boundary.mesh_vertex);
    if (const auto& vertices = numbering_.input.vertices; !vertices.empty())
      for (int& v : skin_vertex_) v = vertices[static_cast<std::size_t>(v)];
  }
}

void RunFiles::write(const Snapshot& snapshot) {
  write_surface(snapshot);
  if (volume_frames_) write_volume(snapshot);
  history_.write(snapshot);
  last_time_ = snapshot.time;
}

void RunFiles::write_surface(const Snapshot& snapshot) {
  const bool embedded = skin_vertex_.empty();
  VtuGrid grid;
  grid.time = snapshot.time;
  grid.points = embedded ? snapshot.surface : gathered(snapshot.positions, skin_vertex_);
  grid.connectivity = flat(skin_.triangles);
  grid.point_fields = {
      {"displacement", displacements(grid.points, skin_.vertices, placement_)},
      {"velocity", embedded ? snapshot.surface_velocities : gathered(snapshot.velocities, skin_vertex_)}};
  surface_frames_.write(grid);
}

void RunFiles::write_volume(const Snapshot& snapshot) {
  VtuGrid grid;
  grid.time = snapshot.time;
  const std::vector<int>& order = numbering_.input.vertices;
  grid.points = in_input_order(snapshot.positions, order);
  grid.connectivity = flat(finest_.tets);
  grid.vertices_per_cell = 4;
  grid.point_fields = {{"displacement", displacements(grid.points, finest_.vertices, placement_)},
                       {"velocity", in_input_order(snapshot.velocities, order)}};
  const bool has_numbers = !numbering_.tet_ids.empty();  // a reader must not take them for regions
  if (!finest_.region.empty()) grid.cell_fields.push_back({"region", finest_.region});
  if (finest_.region.empty() && has_numbers)
    grid.cell_fields.push_back({"region", std::vector<int>(finest_.tets.size(), 0)});
  if (has_numbers) grid.cell_fields.push_back({"number", in_input_order(numbering_.tet_ids, numbering_.input.tets)});
  volume_frames_->write(grid);
}

}  // namespace plica::app
