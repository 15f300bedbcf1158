// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/meshes/ball_mesh.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/box_mesh.hpp>
#include <plica/meshes/cylinder_mesh.hpp>
#include <plica/meshes/read_mesh.hpp>
#include <plica/meshes/read_surface.hpp>
#include <plica/meshes/sphere_surface.hpp>

namespace plica::app {
namespace {

std::filesystem::path existing(const std::string& name, const Scene& scene, const Where& where, const char* what) {
  const std::filesystem::path file = std::filesystem::path(scene.file).parent_path() / name;
  if (!std::filesystem::exists(file))
    throw InputError(fmt::format("there is no {} file '{}' (its name is relative to the scene)", what, file.string()),
                     where);
  return file;
}

TetMesh from_file(const LevelRecipe& recipe, const Scene& scene, const Where& where) {
  TetMesh mesh = read_mesh(existing(recipe.file, scene, where, "mesh"));
  for (Point& vertex : mesh.vertices) vertex *= recipe.scale;
  return mesh;
}

TetMesh generated(const LevelRecipe& recipe) {
  if (const auto& box = recipe.box) return box_mesh({box->origin, box->origin + box->size}, box->cells);
  if (const auto& ball = recipe.ball) return ball_mesh(ball->centre, ball->radius, ball->cells);
  const CylinderRecipe& cylinder = *recipe.cylinder;
  return cylinder_mesh(cylinder.base, cylinder.radius, cylinder.length, cylinder.across, cylinder.along);
}

TriangleSurface surface_of(const SurfaceRecipe& recipe, const TetMesh& finest) {
  if (recipe.boundary) return boundary_surface(finest).surface;
  const Box box = bounding_box(finest.vertices);
  const Point middle = (box.min + box.max) / 2;
  return sphere_surface(recipe.sphere->centre.value_or(middle), recipe.sphere->radius, recipe.sphere->subdivisions);
}

TriangleSurface tool_surface(const ToolRecipe& recipe, const Scene& scene, const Where& where) {
  const std::filesystem::path file = existing(recipe.file, scene, where, "surface");
  SurfaceReport report;
  TriangleSurface surface = read_surface(file, &report);
  if (!report.closed())
    throw InputError(
        fmt::format("the surface '{}' has no inside: {} open edges, {} edges of more than two triangles, {} "
                    "edges between triangles that look to different sides",
                    file.string(), report.open_edges, report.crowded_edges, report.inconsistent_edges),
        where);
  const double angle = recipe.rotation.norm();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle, angle > 0 ? Point(recipe.rotation / angle) : Point::UnitZ()).toRotationMatrix();
  for (Point& vertex : surface.vertices) vertex = turn * (recipe.scale * vertex) + recipe.position;
  return surface;
}

// A generator knows nothing of files: what it refuses gets the place of its recipe
template <class Make>
auto placed(const Where& where, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(error.what(), where);
  }
}

void check_name(const std::string& kind, const std::string& name, const std::vector<std::string>& known,
                const std::string& path, const Tree& tree) {
  if (std::ranges::find(known, name) != known.end()) return;
  throw InputError(path + ": " +
                       (known.empty() ? fmt::format("there is no {} '{}': the meshes name none", kind, name)
                                      : unknown_name(kind, name, known)),
                   place_of(tree, path));
}

void check_names(const Selection& selection, const std::string& path, const std::vector<std::string>& groups,
                 const std::vector<std::string>& regions, const Tree& tree) {
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
    if (region.where) check_names(*region.where, "body.regions." + name + ".where", groups, regions, tree);
  for (const auto& [name, region] : body.regions)
    if (region.where) groups.push_back(name), regions.push_back(name);
  for (std::size_t i = 0; i < body.fixed.size(); ++i)
    check_names(body.fixed[i], fmt::format("body.fixed.{}", i), groups, regions, tree);
  for (std::size_t i = 0; i < body.prescribed.size(); ++i)
    check_names(body.prescribed[i].where, fmt::format("body.prescribed.{}", i), groups, regions, tree);
  for (std::size_t i = 0; i < body.loads.size(); ++i)
    check_names(body.loads[i].where, fmt::format("body.loads.{}", i), groups, regions, tree);
}

}  // namespace

void build_meshes(Scene& scene, const Tree& tree) {
  Body& body = scene.problem.body;
  body.levels.clear();
  for (std::size_t i = 0; i < scene.levels.size(); ++i) {
    const LevelRecipe& recipe = scene.levels[i];
    const Where where = place_of(tree, fmt::format("body.levels.{}", i));
    body.levels.push_back(recipe.file.empty() ? placed(where, [&] { return generated(recipe); })
                                              : from_file(recipe, scene, where));
  }
  if (scene.surface)
    body.surface = placed(place_of(tree, "body.surface"), [&] { return surface_of(*scene.surface, body.levels[0]); });
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
    if (const auto& tool = scene.obstacles[i].tool)
      std::get<SurfaceOptions>(scene.problem.contact.obstacles[i].shape).surface =
          tool_surface(*tool, scene, place_of(tree, fmt::format("contact.obstacles.{}.surface.file", i)));
  check_names(body, tree);
}

}  // namespace plica::app
