// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/meshes/ball_mesh.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/box_mesh.hpp>
#include <plica/meshes/cylinder_mesh.hpp>
#include <plica/meshes/read_mesh.hpp>
#include <plica/meshes/sphere_surface.hpp>

namespace plica::app {
namespace {

TetMesh from_file(const LevelRecipe& recipe, const Scene& scene, const Where& where) {
  const std::filesystem::path file = std::filesystem::path(scene.file).parent_path() / recipe.file;
  if (!std::filesystem::exists(file))
    throw InputError("there is no mesh file '" + file.string() + "' (its name is relative to the scene)", where);
  TetMesh mesh = read_mesh(file);
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
  for (const auto& [name, region] : body.regions) check_name("region", name, regions, "body.regions." + name, tree);
  for (std::size_t i = 0; i < body.fixed.size(); ++i)
    if (!body.fixed[i].box)
      check_name("group", body.fixed[i].group, groups, fmt::format("body.fixed.{}.group", i), tree);
  for (std::size_t i = 0; i < body.prescribed.size(); ++i)
    if (!body.prescribed[i].where.box)
      check_name("group", body.prescribed[i].where.group, groups, fmt::format("body.prescribed.{}.group", i), tree);
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
  check_names(body, tree);
}

}  // namespace plica::app
