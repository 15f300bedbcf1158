// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/body/body_parts.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/body/supports.hpp>
#include <plica/drivers/elastic/fibres.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/cut.hpp>

namespace plica::app {

namespace {

bool is_closed(const GraspOptions& grasp, double time, double macro_step) {
  for (std::size_t i = 0; i < grasp.from.size(); ++i)
    if (grasp.from[i] + macro_step < time && (i >= grasp.until.size() || time < grasp.until[i]))
      return true;
  return false;
}

}  // namespace

std::vector<std::string> empty_handed(const ContactOptions& contact, const Snapshot& now,
                                      double macro_step) {
  std::vector<std::string> names;
  for (std::size_t o = 0; o < contact.obstacles.size(); ++o) {
    const auto& grasp = contact.obstacles[o].grasp;
    const std::string name = obstacle_name(contact, o);
    if (!grasp || !is_closed(*grasp, now.time, macro_step)) continue;
    for (const HeldBy& held : now.held)
      if (held.obstacle == name && held.points.empty()) names.push_back(name);
  }
  return names;
}

std::vector<double> vertex_masses(const Body& body, int level) {
  const TetMesh& mesh = body.levels[static_cast<std::size_t>(level)];
  return lumped_masses(mesh, region_densities(body, mesh));
}

namespace {

constexpr const char* history_columns =
    "time,kinetic_energy,elastic_energy,potential_energy,contact_energy,total_energy,"
    "com_x,com_y,com_z,max_speed,rms_speed";

bool has_strength(const ContactOptions& contact) {
  return std::ranges::any_of(contact.attachments,
                             [](const auto& a) { return a.strength.has_value(); });
}

std::vector<std::size_t> rubbing_obstacles(const ContactOptions& contact) {
  std::vector<std::size_t> all;
  for (std::size_t o = 0; o < contact.obstacles.size(); ++o)
    if (contact.obstacles[o].friction.value_or(0) > 0) all.push_back(o);
  return all;
}

}  // namespace

bool has_friction(const ContactOptions& contact) {
  return contact.friction.value_or(0) > 0 || !rubbing_obstacles(contact).empty();
}

namespace {

std::string history_head(const Problem& problem) {
  std::string all(history_columns);
  const auto add = [&](const std::string& name, std::initializer_list<const char*> quantities) {
    for (const char* quantity : quantities)
      for (const char axis : {'x', 'y', 'z'}) all += fmt::format(",{}.{}_{}", name, quantity, axis);
  };
  for (const std::string& name : wrench_names(problem)) add(name, {"force", "torque"});
  for (std::size_t o = 0; o < problem.contact.obstacles.size(); ++o)
    if (problem.contact.obstacles[o].mass) {
      add(obstacle_name(problem.contact, o), {"displacement", "velocity"});
      if (!problem.contact.obstacles[o].inertia.empty())
        add(obstacle_name(problem.contact, o), {"rotation", "angular_velocity"});
    }
  for (std::size_t o = 0; o < problem.contact.obstacles.size(); ++o)
    if (problem.contact.obstacles[o].grasp)
      all += fmt::format(",{}.held", obstacle_name(problem.contact, o));
  for (std::size_t i = 0; i < problem.body.loads.size(); ++i)
    if (std::holds_alternative<EnclosedVolume>(problem.body.loads[i].load))
      all += fmt::format(",load_{0}.volume,load_{0}.pressure", i);
  if (most_halvings(problem) > 0) all += ",step_halvings";
  if (has_friction(problem.contact)) all += ",friction_work";
  for (const std::size_t o : rubbing_obstacles(problem.contact))
    all += fmt::format(",{}.slipping", obstacle_name(problem.contact, o));
  if (has_strength(problem.contact)) all += ",attachments.torn";
  for (const std::string& name : held_names(problem.body)) add(name, {"force", "torque"});
  return all + "\n";
}

}  // namespace

History::History(const std::filesystem::path& file, std::vector<double> masses,
                 const Problem& problem, std::optional<std::uint64_t> kept)
    : file_(kept ? GrowingFile(file, *kept) : GrowingFile(file, history_head(problem))),
      masses_(std::move(masses)),
      tears_(has_strength(problem.contact)),
      halves_(most_halvings(problem) > 0),
      rubs_(has_friction(problem.contact)),
      rubbing_(rubbing_obstacles(problem.contact)) {}

void History::write(const Snapshot& s) {
  double mass = 0, max_square = 0, sum_square = 0;
  Point centre = Point::Zero();
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    const double square = s.velocities[i].squaredNorm();
    mass += masses_[i];
    centre += masses_[i] * s.positions[i];
    sum_square += masses_[i] * square;
    max_square = std::max(max_square, square);
  }
  centre /= mass;
  const Energies& e = s.energies;
  std::string row =
      fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}",
                  s.time, e.kinetic, e.elastic, e.potential, e.contact, e.total(), centre.x(),
                  centre.y(), centre.z(), std::sqrt(max_square), std::sqrt(sum_square / mass));
  const auto add = [&](const Point& p) {
    row += fmt::format(",{:.9g},{:.9g},{:.9g}", p.x(), p.y(), p.z());
  };
  for (const Wrench& w : s.wrenches) add(w.force), add(w.torque);
  for (const ToolState& t : s.tools) {
    add(t.displacement), add(t.velocity);
    if (t.turns) add(t.rotation), add(t.angular_velocity);
  }
  for (const HeldBy& h : s.held) row += fmt::format(",{}", h.points.size());
  for (const CavityState& c : s.cavities)
    row += fmt::format(",{:.9g},{:.9g}", c.volume, c.pressure);
  if (halves_) row += fmt::format(",{}", s.step_halvings);
  if (rubs_) row += fmt::format(",{:.9g}", s.friction_work);
  for (const std::size_t o : rubbing_) row += fmt::format(",{:.9g}", s.slipping.at(o));
  if (tears_) row += fmt::format(",{}", s.torn);
  for (const Reaction& r : s.reactions) add(r.force), add(r.torque);
  file_.add(row + "\n");
}

namespace {

constexpr const char* fibre_field = "fibre";

std::vector<Point> displacements(const std::vector<Point>& positions,
                                 const std::vector<Point>& rest, const Point& placement) {
  std::vector<Point> result(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) result[i] = positions[i] - rest[i] - placement;
  return result;
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

Body with_regions(Body body) {
  for (std::size_t i = 0; i < body.levels.size(); ++i)
    add_regions(body.levels[i], body.regions, static_cast<int>(i));
  return body;
}

// Adds the fibre directions at rest to a level's mesh, as a field that frames show
void add_fibres(Body& body, std::size_t level) {
  std::vector<Point> directions;
  for (const FibreAxes& axes : element_fibres(body, body.levels[level], static_cast<int>(level)))
    directions.push_back(axes[0]);
  body.levels[level].tet_vectors[fibre_field] = std::move(directions);
}

std::string volume_name(int level) {
  return level == 0 ? "volume" : fmt::format("volume_level{}", level);
}

std::vector<int> written_levels(const Scene& scene) {
  const VolumeLevels& chosen = scene.output.volume;
  if (!chosen.all) return chosen.levels;
  std::vector<int> levels(
      integrated_levels(scene.problem.integration.cycle, count_levels(scene.levels)));
  std::iota(levels.begin(), levels.end(), 0);
  return levels;
}

// Removes the files of a former run. The checkpoint goes first, since without the other files it is
// useless. A page report.html is removed only with a run, since otherwise it shows something else
const std::filesystem::path& without_former_run(const std::filesystem::path& folder) {
  std::error_code ignored;
  const bool has_run = !former_run(folder).empty();
  for (const char* file : {"checkpoint.bin", "checkpoint.bin.part", "summary.json", "probes.csv"})
    std::filesystem::remove(folder / file, ignored);
  if (has_run) std::filesystem::remove(folder / "report.html", ignored);
  std::vector<std::string> films = {"volume"};
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".pvd" &&
        entry.path().stem().string().starts_with("volume_level"))
      films.push_back(entry.path().stem().string());
  for (const std::string& film : films) Frames(folder, film, film + ".pvd");
  return folder;
}

}  // namespace

std::vector<std::string> former_run(const std::filesystem::path& folder) {
  std::vector<std::string> found;
  for (const char* file :
       {"checkpoint.bin", "summary.json", "history.csv", "probes.csv", "frames.pvd"})
    if (std::filesystem::exists(folder / file)) found.emplace_back(file);
  return found;
}

RunFiles::RunFiles(const Scene& scene, const std::filesystem::path& folder,
                   const std::optional<FilesMark>& from)
    : body_(with_regions(scene.problem.body)),
      numbering_(scene.numbering),
      output_(scene.output),
      placement_(placement_of(body_)),
      volume_levels_(written_levels(scene)),
      frame_times_(from ? from->frame_times : std::vector<double>{}),
      surface_frames_(from ? folder : without_former_run(folder), "surface", "frames.pvd",
                      frame_times_),
      history_(folder / "history.csv", vertex_masses(body_), scene.problem,
               from ? std::optional(from->history_bytes) : std::nullopt) {
  std::error_code ignored;
  std::filesystem::remove(folder / "summary.json", ignored);
  for (const int level : volume_levels_) {
    volume_frames_.emplace_back(folder, volume_name(level), volume_name(level) + ".pvd",
                                frame_times_);
    const auto i = static_cast<std::size_t>(level);
    if (has_fibres(body_)) add_fibres(body_, i);
    volumes_.push_back({in_input_order(body_.levels[i], numbering_[i]),
                        in_input_order(vertex_masses(body_, level), numbering_[i].input.vertices)});
  }
  if (body_.surface) {
    skin_ = *body_.surface;
  } else {
    BoundarySurface boundary =
        boundary_surface(in_input_order(body_.levels.front(), numbering_.front()));
    skin_ = std::move(boundary.surface);
    skin_vertex_ = std::move(boundary.mesh_vertex);
    if (const auto& vertices = numbering_.front().input.vertices; !vertices.empty())
      for (int& v : skin_vertex_) v = vertices[static_cast<std::size_t>(v)];
  }
  if (body_.parts.empty()) return;
  const std::vector<int> part = body_.surface
                                    ? parts_of_points(body_.parts)
                                    : parts_of_vertices(body_.levels.front(), body_.parts);
  for (const auto& t : skin_.triangles) {
    const auto p = static_cast<std::size_t>(t[0]);
    skin_body_.push_back(part[body_.surface ? p : static_cast<std::size_t>(skin_vertex_[p])]);
  }
}

// A body that is cut is not moved to its place, so that the mesh is that of the scene
void RunFiles::take_cut(const TetMesh& mesh, const std::optional<TriangleSurface>& surface,
                        const std::vector<int>& surface_vertices) {
  TetMesh& own = body_.levels.front();
  own.vertices = mesh.vertices, own.tets = mesh.tets;
  std::vector<int>& input = numbering_.front().input.vertices;
  for (std::size_t v = input.size(); !input.empty() && v < own.vertices.size(); ++v)
    input.push_back(static_cast<int>(v));
  for (std::size_t i = 0; i < volumes_.size(); ++i)
    if (volume_levels_[i] == 0)
      volumes_[i] = {in_input_order(own, numbering_.front()),
                     in_input_order(vertex_masses(body_), input)};
  if (surface) {
    skin_ = *surface;
  } else {
    for (std::size_t p = skin_vertex_.size(); p < surface_vertices.size(); ++p) {
      skin_vertex_.push_back(surface_vertices[p]);
      skin_.vertices.push_back(own.vertices[static_cast<std::size_t>(surface_vertices[p])]);
    }
    follow_cut(own, skin_, skin_vertex_);
  }
  history_.set_masses(vertex_masses(body_));
}

// A body whose part follows an obstacle is not moved to its place either, and has a surface that
// stays
void RunFiles::take_mesh(const TetMesh& mesh) {
  body_.levels.front() = mesh;
  for (std::size_t i = 0; i < volumes_.size(); ++i) {
    if (volume_levels_[i] != 0) continue;
    if (has_fibres(body_)) add_fibres(body_, 0);
    volumes_[i] = {body_.levels.front(), vertex_masses(body_)};
  }
  history_.set_masses(vertex_masses(body_));
}

void RunFiles::write(const Snapshot& snapshot) {
  surface_frames_.write(surface_grid(snapshot));
  for (std::size_t i = 0; i < volume_frames_.size(); ++i)
    volume_frames_[i].write(volume_grid(snapshot.volumes[i], volumes_[i], snapshot.time));
  history_.write(snapshot);
  frame_times_.push_back(snapshot.time);
}

void RunFiles::cut_back(std::size_t frames, std::uint64_t history_bytes) {
  surface_frames_.cut_back(frames);
  for (Frames& volume : volume_frames_) volume.cut_back(frames);
  history_.file().cut_back(history_bytes);
  frame_times_.resize(frames);
}

void RunFiles::sync() {
  surface_frames_.sync();
  for (Frames& frames : volume_frames_) frames.sync();
  history_.file().sync();
}

namespace {

/// Returns u and v of each point, of the last triangle around it: [points][2]. They are 0 where the
/// surface has no texture, as after a cut.
std::vector<double> texture_of_points(const TriangleSurface& surface) {
  std::vector<double> values(2 * surface.vertices.size(), 0.0);
  if (surface.texture.size() != surface.triangles.size()) return values;
  for (std::size_t t = 0; t < surface.texture.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      std::ranges::copy(surface.texture[t][k],
                        values.begin() + 2 * std::ptrdiff_t{surface.triangles[t][k]});
  return values;
}

}  // namespace

VtuGrid RunFiles::surface_grid(const Snapshot& snapshot) const {
  const bool embedded = skin_vertex_.empty();
  VtuGrid grid;
  grid.time = snapshot.time;
  grid.points = embedded ? snapshot.surface : gathered(snapshot.positions, skin_vertex_);
  grid.connectivity = flat(skin_.triangles);
  grid.point_fields = {{"displacement", displacements(grid.points, skin_.vertices, placement_)},
                       {"velocity", embedded ? snapshot.surface_velocities
                                             : gathered(snapshot.velocities, skin_vertex_)}};
  if (output_.writes(contact_pressure_field)) {
    std::vector<double> pressure = snapshot.contact_pressure;
    pressure.resize(grid.points.size());
    grid.point_scalars.emplace_back(contact_pressure_field, std::move(pressure));
  }
  if (output_.writes(normals_field))
    grid.point_fields.push_back({normals_field, normals_of_points({grid.points, skin_.triangles})});
  if (output_.writes(texture_field))
    grid.point_scalars.emplace_back(texture_field, texture_of_points(skin_), 2);
  if (!skin_body_.empty()) grid.cell_fields.push_back({"body", skin_body_});
  return grid;
}

VtuGrid RunFiles::volume_grid(const VolumeSnapshot& volume, const Volume& constant,
                              double time) const {
  VtuGrid grid;
  const Numbering& numbering = numbering_[static_cast<std::size_t>(volume.level)];
  const TetMesh& mesh = constant.mesh;
  const std::vector<int>&vertices = numbering.input.vertices, &tets = numbering.input.tets;
  grid.time = time;
  grid.points = in_input_order(volume.positions, vertices);
  grid.connectivity = flat(mesh.tets);
  grid.vertices_per_cell = 4;
  grid.point_fields = {{"displacement", displacements(grid.points, mesh.vertices, placement_)},
                       {"velocity", in_input_order(volume.velocities, vertices)}};
  grid.point_scalars = {{"mass", constant.mass}};
  const ElementFields& elements = volume.elements;
  auto& fields = elements.per_vertex ? grid.point_scalars : grid.cell_scalars;
  const std::vector<int>& order = elements.per_vertex ? vertices : tets;
  fields.emplace_back("von_mises", in_input_order(elements.von_mises, order));
  fields.emplace_back("J", in_input_order(elements.J, order));
  const auto add = [&](const char* name, const std::vector<double>& values, int components) {
    if (output_.writes(name))
      fields.emplace_back(name, in_input_order(values, order, components), components);
  };
  add("stress", elements.stress, 6);
  add("pressure", elements.pressure, 1);
  add("principal_stretches", elements.principal_stretches, 3);
  if (has_fibres(body_)) grid.cell_vectors = {{fibre_field, mesh.tet_vectors.at(fibre_field)}};
  // numbers are written with regions, since a reader would take numbers alone for regions
  const bool has_numbers = !numbering.tet_ids.empty();
  if (!mesh.region.empty() || has_numbers)
    grid.cell_fields.push_back(
        {"region", mesh.region.empty() ? std::vector<int>(mesh.tets.size(), 0) : mesh.region});
  if (has_numbers) grid.cell_fields.push_back({"number", in_input_order(numbering.tet_ids, tets)});
  return grid;
}

std::vector<std::string> names_of(const std::map<std::string, Point>& probes) {
  std::vector<std::string> names;
  for (const auto& [name, point] : probes) names.push_back(name);
  return names;
}

std::vector<Point> points_of(const std::map<std::string, Point>& probes) {
  std::vector<Point> points;
  for (const auto& [name, point] : probes) points.push_back(point);
  return points;
}

std::string probe_head(const std::vector<std::string>& names) {
  std::string head = "time";
  for (const std::string& name : names)
    for (const char* column : {"x", "y", "z", "vx", "vy", "vz"}) head += "," + name + "_" + column;
  return head + "\n";
}

std::string probe_row(double time, const std::vector<Point>& positions,
                      const std::vector<Point>& velocities) {
  std::string row = fmt::format("{:.9g}", time);
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (const Point* p : {&positions[i], &velocities[i]})
      row += fmt::format(",{:.9g},{:.9g},{:.9g}", p->x(), p->y(), p->z());
  return row + "\n";
}

}  // namespace plica::app
