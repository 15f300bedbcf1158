// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/join_parts.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/order_levels.hpp>
#include <plica/drivers/app/scene/repair_level.hpp>
#include <plica/drivers/contact/sample_distance.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/close_slits.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/jitter.hpp>
#include <plica/meshes/lattice.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica::app {

namespace {

constexpr double at_the_same_place = 1e-9;  // distance between vertices, in mean edges

// Collects sentences; leaves out those whose count is 0 or whose condition is false
class Sentences {
 public:
  void add(int count, const std::string& noun, const std::string& rest) {
    if (count > 0) list_.push_back(counted(count, noun) + " " + rest);
  }
  void add(bool is_so, const std::string& sentence) {
    if (is_so) list_.push_back(sentence);
  }
  std::vector<std::string> take() { return std::move(list_); }

 private:
  std::vector<std::string> list_;
};

constexpr double part_of_length = 0.02;  // thickness of a sheet over its longest extent
constexpr double largest_body = 3, smallest_body = 1e-4;  // expected extents of a body [m]

double extent_of(const TetMesh& mesh) {
  const Box box = bounding_box(mesh.vertices);
  return (box.max - box.min).maxCoeff();
}

bool no_body(const TetMesh& mesh) {
  return extent_of(mesh) > largest_body || extent_of(mesh) < smallest_body;
}

// Returns a sentence about the size of a body that is too large or too small. For a body from a
// file, it says that the file may be in another unit; else that the numbers may lack their unit
std::string size_text(const TetMesh& mesh, bool of_file) {
  const double extent = extent_of(mesh);
  std::string text = fmt::format("the body is {:.4g} m long", extent);
  const struct {
    const char* unit;
    double scale;
  } units[] = {{"mm", 0.001}, {"cm", 0.01}, {"um", 1e-6}};
  for (const auto& [unit, scale] : units)
    if (extent > largest_body && extent * scale > 0.005 && extent * scale < largest_body)
      return text +
             (of_file ? fmt::format("; is the file in {}? Then its scale is {:g}", unit, scale)
                      : fmt::format(
                            "; are its numbers in {0}? A number may have its unit, such as 5 {0}",
                            unit));
  return text;
}

// Says that a region may be the air around an organ: segmentations number it 0
void add_background(const TetMesh& mesh, const MeshReport& report, Sentences& sentences) {
  const auto& tags = report.groups.region_tags;
  const auto zero = std::ranges::find(tags, 0);
  if (zero == tags.end() || tags.size() < 2 || tags.size() != mesh.region_names.size()) return;
  const auto region = static_cast<int>(zero - tags.begin());
  double inside = 0, all = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto corners = corners_of(mesh, static_cast<int>(t));
    const double volume = tet_volume(corners[0], corners[1], corners[2], corners[3]);
    all += volume, inside += mesh.region[t] == region ? volume : 0;
  }
  const std::string& name = mesh.region_names[static_cast<std::size_t>(region)];
  sentences.add(inside > all / 2,
                fmt::format("the region {} has {:.0f} % of the volume; is it the air around the "
                            "body? Then leave_out: [{}]",
                            name, 100 * inside / all, name));
}

}  // namespace

std::vector<std::string> mesh_warnings(const TetMesh& mesh, const MeshReport& report,
                                       bool in_metres) {
  Sentences sentences;
  for (const auto& [kind, count] : report.linearised)
    sentences.add(count, kind, "taken by the corners alone");
  for (const auto& [kind, count] : report.cut) sentences.add(count, kind, "cut into tetrahedra");
  sentences.add(report.flipped, "element", "inside out in the file: turned");
  sentences.add(report.unreferenced, "unused point", "dropped");
  sentences.add(count_duplicate_vertices(mesh, at_the_same_place * mean_edge_length(mesh)),
                "duplicate",
                "among the vertices: at the place of another one, where the mesh may come apart "
                "(merge them?)");
  sentences.add(in_metres && no_body(mesh), size_text(mesh, true));
  const int parts = count_parts(mesh);
  sentences.add(parts > 1, fmt::format("the mesh has {} parts that share no vertex", parts));
  for (const std::string& section : report.skipped_sections)
    sentences.add(true, "the section " + section + " is not read");
  sentences.add(report.split, "second-order tetrahedron",
                "split in eight by the nodes on the edges");
  for (const auto& [region, count] : report.left_out)
    sentences.add(count, "tetrahedron", "of the region " + region + " left out");
  for (const std::string& note : report.notes) sentences.add(true, note);
  add_background(mesh, report, sentences);
  return sentences.take();
}

std::vector<std::string> surface_warnings(const SurfaceReport& report) {
  Sentences sentences;
  for (const auto& [kind, count] : report.linearised)
    sentences.add(count, kind, "taken by the corners alone");
  sentences.add(report.left_out, "bad face", "left out");
  sentences.add(report.unreferenced, "unused point", "dropped");
  sentences.add(report.collapsed, "collapsed triangle", "dropped: it names a vertex twice");
  sentences.add(report.repeated, "repeated triangle", "dropped");
  sentences.add(report.open_edges, "open edge", "of one triangle only: the surface is not closed");
  sentences.add(report.crowded_edges, "crowded edge",
                "of more than two triangles: the surface is no manifold");
  sentences.add(report.inconsistent_edges, "inconsistent edge",
                "of triangles that face different sides");
  sentences.add(report.parts > 1,
                fmt::format("the surface has {} parts that share no vertex", report.parts));
  sentences.add(report.turned, "the surface was inside out: all triangles turned");
  sentences.add(report.welded, "point", "on open edges welded to another one at the same place");
  for (const std::string& note : report.notes) sentences.add(true, note);
  return sentences.take();
}

std::string why_open(const SurfaceReport& report) {
  const Point& at = report.open_at;
  return fmt::format(
      "has no inside: {} open edges, {} edges of more than two triangles, {} edges between "
      "triangles that face "
      "different sides; the first is at [{:.4g}, {:.4g}, {:.4g}] in the file's unit",
      report.open_edges, report.crowded_edges, report.inconsistent_edges, at[0], at[1], at[2]);
}

namespace {

// Calls make() and adds the location in the scene to an InputError that it throws. Generators and
// readers of mesh files do not know the scene
template <class Make>
auto placed(const SourceLocation& where, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(error.what(), where);
  }
}

std::filesystem::path found(const std::string& kind, const std::string& name, const Scene& scene,
                            const SourceLocation& where) {
  const std::filesystem::path file = std::filesystem::path(scene.file).parent_path() / name;
  if (std::error_code error;
      std::filesystem::status(file, error).type() == std::filesystem::file_type::not_found)
    throw InputError(
        "there is no " + kind + " file '" + file.string() + "' (its name is relative to the scene)",
        where);
  return file;
}

void warn(Scene& scene, const std::filesystem::path& file,
          const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    scene.warnings.push_back(file.string() + ": " + warning);
}

// Returns the numbers in the file, in the new order. If one does not fit an int, returns `order`:
// the positions in the file
std::vector<int> ids_of(const std::vector<std::int64_t>& tags, const std::vector<int>& order) {
  const auto fits = [](std::int64_t tag) {
    return tag >= 0 && tag <= std::numeric_limits<int>::max();
  };
  if (!std::ranges::all_of(tags, fits)) return order;
  std::vector<int> ids;
  for (const int old : order) ids.push_back(static_cast<int>(tags[static_cast<std::size_t>(old)]));
  return ids;
}

// Reads a level's mesh, scales it, and merges duplicates and repairs it if asked. Then puts it in
// an order that is fast to simulate. `numbering` maps this order to that of the file
TetMesh from_file(const LevelRecipe& recipe, Scene& scene, const SourceLocation& where,
                  Numbering& numbering) {
  const std::filesystem::path file = found("mesh", recipe.file, scene, where);
  MeshReport report;
  const ReadOptions options = {recipe.repair ? Flaws::kept : Flaws::refused, recipe.regions,
                               recipe.leave_out, second_order_named(recipe.order)};
  TetMesh mesh = placed(where, [&] { return read_mesh(file, &report, options); });
  for (Point& vertex : mesh.vertices) vertex *= recipe.scale;
  if (recipe.merge_duplicates) {
    MergedMesh merged =
        placed(where, [&] { return merge_duplicates(mesh, *recipe.merge_duplicates); });
    mesh = std::move(merged.mesh);
    report.vertex_tags = permuted(report.vertex_tags, merged.original_vertex);
    if (merged.merged > 0)
      warn(scene, file, {fmt::format("merged {} duplicate vertices", merged.merged)});
  }
  if (recipe.repair) {
    std::vector<std::string> changes;
    mesh =
        placed(where, [&] { return repaired(mesh, report, scene.problem.body.material, changes); });
    warn(scene, file, changes);
  }
  warn(scene, file, mesh_warnings(mesh, report));
  const Reordering order = better_order(mesh);
  numbering = {inverse(order), ids_of(report.vertex_tags, order.vertices),
               ids_of(report.tet_tags, order.tets)};
  return reordered(mesh, order);
}

TriangleSurface from_file(const SurfaceRecipe& recipe, Scene& scene, const SourceLocation& where) {
  const std::filesystem::path file = found("surface", recipe.file, scene, where);
  SurfaceReport report;
  TriangleSurface surface = placed(where, [&] { return read_surface(file, &report, recipe.weld); });
  for (Point& vertex : surface.vertices) vertex *= recipe.scale;
  warn(scene, file, surface_warnings(report));
  return surface;
}

// Reads a closed surface; from a file that holds a mesh, its boundary
TriangleSurface closed_surface(const LatticesRecipe& recipe, Scene& scene,
                               const SourceLocation& where) {
  const std::filesystem::path file = found("surface", recipe.surface, scene, where);
  auto read = placed(where, [&] { return read_any(file, {.weld = recipe.weld}); });
  TriangleSurface surface;
  if (const auto* mesh = std::get_if<ReadMesh>(&read)) {
    warn(scene, file, mesh_warnings(mesh->mesh, mesh->report));
    surface = boundary_surface(mesh->mesh).surface;
  } else {
    const SurfaceReport& report = std::get<ReadSurface>(read).report;
    if (!report.closed())
      throw InputError(fmt::format("the surface '{}' {}", file.string(), why_open(report)), where);
    warn(scene, file, surface_warnings(report));
    surface = std::move(std::get<ReadSurface>(read).surface);
  }
  for (Point& vertex : surface.vertices) vertex *= recipe.scale;
  return surface;
}

// Makes a lattice over the closed surface for each level. The surface is embedded in the levels,
// unless the scene has another embedded surface
void lay_lattices(Scene& scene, const Tree& tree) {
  Body& body = scene.problem.body;
  const SourceLocation where = place_of(tree, "body.levels.surface");
  body.surface = closed_surface(*scene.lattices, scene, where);
  for (std::size_t i = 0; i < scene.levels.size(); ++i) {
    const double size = *scene.levels[i].lattice;
    WeightedLattice lattice = placed(place_of(tree, fmt::format("body.levels.sizes.{}", i)),
                                     [&] { return weighted_lattice(*body.surface, size); });
    if (lattice.shared_cells > 0)
      warn(scene, scene.lattices->surface,
           {fmt::format("{} of {:g} m {} several unconnected parts of the body, which the lattice "
                        "connects there; "
                        "smaller cells keep them apart",
                        counted(lattice.shared_cells, "cell"), size,
                        lattice.shared_cells == 1 ? "holds" : "hold")});
    body.levels.push_back(std::move(lattice.mesh));
  }
}

TetMesh generated(const LevelRecipe& recipe) {
  if (const auto& box = recipe.box)
    return box_mesh({box->origin, box->origin + box->size}, box->cells);
  if (const auto& ball = recipe.ball) return ball_mesh(ball->centre, ball->radius, ball->cells);
  if (const auto& blob = recipe.blob) return blob_mesh(blob->centre, blob->length, blob->cells);
  if (const auto& tube = recipe.tube) return tube_mesh(*tube);
  const CylinderRecipe& cylinder = *recipe.cylinder;
  return cylinder_mesh(cylinder.base, cylinder.radius, cylinder.length, cylinder.across,
                       cylinder.along);
}

TriangleSurface surface_of(const SurfaceRecipe& recipe, const TetMesh& finest,
                           const Numbering& numbering) {
  if (recipe.boundary) return boundary_surface(in_input_order(finest, numbering)).surface;
  const Box box = bounding_box(finest.vertices);
  const Point middle = (box.min + box.max) / 2;
  return sphere_surface(recipe.sphere->centre.value_or(middle), recipe.sphere->radius,
                        recipe.sphere->subdivisions);
}

// Closes the slits of a surface that its distance grid does not see, and says so
void close_tool(TriangleSurface& surface, SurfaceReport& report, const ToolRecipe& recipe,
                const std::filesystem::path& file, Scene& scene) {
  const double cell = distance_cell(surface, recipe.options.cells);
  const int slits = close_slits(surface, cell);
  if (slits == 0) return;
  warn(scene, file,
       {fmt::format("{} narrower than a cell of its distance grid, {:.3g} m, {} closed; with a "
                    "thickness it is a sheet instead",
                    counted(slits, "slit"), recipe.scale * cell, slits > 1 ? "are" : "is")});
  report.open_edges = report.crowded_edges = report.inconsistent_edges = 0;
  count_edges(surface, report);
}

// Returns the thickness of a sheet for a surface that is not closed, and says so [m]
double sheet_thickness(const TriangleSurface& surface, const SurfaceReport& report,
                       const ToolRecipe& recipe, const std::filesystem::path& file, Scene& scene) {
  const Box box = bounding_box(surface.vertices);
  const double thickness = part_of_length * recipe.scale * (box.max - box.min).maxCoeff();
  warn(
      scene, file,
      {fmt::format("it {}; it is taken as a sheet of {:.3g} m, a fiftieth of its length: thickness "
                   "gives another one. For an inside, close it, or choose fewer cells, which "
                   "closes wider slits",
                   why_open(report), thickness)});
  return thickness;
}

// Reads the surface of a tool. Where it is not closed, `thickness` becomes that of a sheet
TriangleSurface tool_surface(const ToolRecipe& recipe, double& thickness, Scene& scene,
                             const SourceLocation& where) {
  const std::filesystem::path file = found("surface", recipe.file, scene, where);
  SurfaceReport report;
  TriangleSurface surface = placed(where, [&] { return read_surface(file, &report, recipe.weld); });
  if (thickness == 0 && report.open_edges > 0) close_tool(surface, report, recipe, file, scene);
  if (thickness == 0 && !report.closed())
    thickness = sheet_thickness(surface, report, recipe, file, scene);
  if (thickness > 0) report.open_edges = 0;  // open edges are no fault of a sheet
  warn(scene, file, surface_warnings(report));
  const double angle = recipe.rotation.norm();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle, angle > 0 ? Point(recipe.rotation / angle) : Point::UnitZ())
          .toRotationMatrix();
  for (Point& vertex : surface.vertices) vertex = turn * (recipe.scale * vertex) + recipe.position;
  return surface;
}

void check_name(const std::string& kind, const std::string& name,
                const std::vector<std::string>& known, const std::string& path, const Tree& tree) {
  if (std::ranges::find(known, name) != known.end()) return;
  throw InputError(
      path + ": " +
          (known.empty() ? fmt::format("there is no {} '{}': the meshes name none", kind, name)
                         : unknown_name(kind, name, known)),
      place_of(tree, path));
}

void check_names(const Selection& selection, const std::string& path,
                 const std::vector<std::string>& groups, const std::vector<std::string>& regions,
                 const Tree& tree) {
  if (const auto* group = std::get_if<GroupSelection>(&selection))
    check_name("group", group->name, groups, path + ".group", tree);
  if (const auto* region = std::get_if<RegionSelection>(&selection))
    check_name("region", region->name, regions, path + ".region", tree);
}

void check_names(const Body& body, const Tree& tree) {
  std::vector<std::string> regions, groups;
  for (const TetMesh& mesh : body.levels) {
    regions.insert(regions.end(), mesh.region_names.begin(), mesh.region_names.end());
    for (const auto& [name, vertices] : mesh.vertex_sets) groups.push_back(name);
  }
  groups.insert(groups.end(), regions.begin(), regions.end());
  for (std::vector<std::string>* names : {&regions, &groups}) {
    std::ranges::sort(*names);
    names->erase(std::unique(names->begin(), names->end()), names->end());
  }
  for (const auto& [name, region] : body.regions)
    if (!region.where) check_name("region", name, regions, "body.regions." + name, tree);
  for (const auto& [name, region] : body.regions)
    if (region.where)
      check_names(*region.where, "body.regions." + name + ".where", groups, regions, tree);
  for (const auto& [name, region] : body.regions)
    if (region.where) groups.push_back(name), regions.push_back(name);
  const auto check_fibres = [&](const std::string& path,
                                const std::optional<FibreOptions>& fibres) {
    if (fibres && fibres->from) check_names(*fibres->from, path + ".from", groups, regions, tree);
    if (fibres && fibres->to) check_names(*fibres->to, path + ".to", groups, regions, tree);
  };
  check_fibres("body.fibres", body.material.fibres);
  for (const auto& [name, region] : body.regions)
    check_fibres("body.regions." + name + ".fibres", region.fibres);
  for (std::size_t i = 0; i < body.fixed.size(); ++i)
    check_names(body.fixed[i].where, fmt::format("body.fixed.{}", i), groups, regions, tree);
  for (std::size_t i = 0; i < body.prescribed.size(); ++i)
    check_names(body.prescribed[i].where, fmt::format("body.prescribed.{}", i), groups, regions,
                tree);
  for (std::size_t i = 0; i < body.loads.size(); ++i)
    check_names(body.loads[i].where, fmt::format("body.loads.{}", i), groups, regions, tree);
  for (std::size_t i = 0; i < body.initial.parts.size(); ++i)
    check_names(body.initial.parts[i].where, fmt::format("body.initial.parts.{}", i), groups,
                regions, tree);
}

}  // namespace

TetMesh finer_mesh(const Scene& scene) {
  LevelRecipe recipe = scene.levels.front();
  const SourceLocation where = place_of(scene.source, "body.levels.0");
  if (is_part(recipe))
    throw InputError("--space needs a finest level of the whole body, got one of a part", where);
  if (recipe.lattice || !recipe.file.empty())
    throw InputError(fmt::format("--space needs a finest level that can be made finer: a box, a "
                                 "ball, a cylinder, a blob or a tube, "
                                 "got a {}; --truth refines any",
                                 recipe.lattice ? "lattice" : "file"),
                     where);
  if (recipe.box)
    for (int& cells : recipe.box->cells) cells *= 2;
  if (recipe.ball) recipe.ball->cells *= 2;
  if (recipe.cylinder) recipe.cylinder->across *= 2, recipe.cylinder->along *= 2;
  if (recipe.blob) recipe.blob->cells *= 2;
  if (recipe.tube) recipe.tube->around *= 2, recipe.tube->across *= 2, recipe.tube->along *= 2;
  return placed(where, [&] { return jittered(generated(recipe), scene.jitter); });
}

void build_meshes(Scene& scene, const Tree& tree) {
  Body& body = scene.problem.body;
  body.levels.clear();
  scene.numbering.assign(scene.levels.size(), {});
  if (scene.lattices) lay_lattices(scene, tree);
  for (std::size_t i = 0; i < scene.levels.size() && !scene.lattices; ++i) {
    const LevelRecipe& recipe = scene.levels[i];
    const SourceLocation where = place_of(tree, fmt::format("body.levels.{}", i));
    if (recipe.refine) {
      body.levels.emplace_back();
      continue;
    }
    body.levels.push_back(recipe.file.empty()
                              ? placed(where, [&] { return generated(recipe); })
                              : from_file(recipe, scene, where, scene.numbering[i]));
    if (scene.jitter > 0)
      body.levels.back() = jittered(std::move(body.levels.back()), scene.jitter);
    if (i == 0 && recipe.file.empty() && no_body(body.levels.back()))
      scene.warnings.push_back(scene.file +
                               ": body.levels.0: " + size_text(body.levels.back(), false));
  }
  join_parts(scene, tree);
  order_levels(scene);
  if (scene.surface) {
    const SourceLocation where = place_of(tree, "body.surface");
    body.surface =
        scene.surface->file.empty()
            ? placed(where,
                     [&] { return surface_of(*scene.surface, body.levels[0], scene.numbering[0]); })
            : from_file(*scene.surface, scene, where);
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
    if (const auto& tool = scene.obstacles[i].tool) {
      auto& shape = std::any_cast<SurfaceOptions&>(scene.problem.contact.obstacles[i].shape);
      shape.surface =
          tool_surface(*tool, shape.thickness, scene,
                       place_of(tree, fmt::format("contact.obstacles.{}.surface.file", i)));
    }
  check_names(body, tree);
}

}  // namespace plica::app
