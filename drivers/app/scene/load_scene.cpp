// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <plica/core/text.hpp>
#include <plica/drivers/app/scene/load_bodies.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/older_keys.hpp>
#include <plica/drivers/app/scene/reader.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica::app {

std::vector<Choice> frame_formats() { return {{"vtu", "VTK's XML format for unstructured grids"}}; }

std::vector<Choice> frame_fields() {
  return {
      {"stress", "Cauchy's stress of tetrahedra, xx yy zz xy yz xz [Pa]"},
      {"pressure", "of tetrahedra, minus a third of the stress's trace [Pa]"},
      {"principal_stretches", "of tetrahedra, the largest first"},
      {contact_pressure_field, "on the points of the surface [Pa]"},
      {normals_field, "on the points of the surface, unit and outwards"},
      {texture_field, "on the points of the surface, u and v of its file; at a seam, one of them"}};
}

std::vector<Choice> precisions() { return {{"float", "32 bits"}, {"double", "64 bits"}}; }
std::vector<Choice> second_orders() {
  return {{"split", "eight linear ones each, by the nodes on the edges"},
          {"linear", "one linear one each, by the corners alone"}};
}

InputError located(const InputError& error, const Tree& source) {
  const std::string message = error.what(),
                    option = message.substr(0, message.find_first_of(" :,"));
  const bool named = source.find(option.substr(0, option.find('.'))) != nullptr;
  return InputError(message,
                    named ? place_of(source, option) : SourceLocation{source.where.file, 0});
}

namespace {

template <class Check>
void with_places(const Tree& tree, const Check& check) {
  try {
    check();
  } catch (const InputError& error) {
    throw located(error, tree);
  }
}

/// Turns the levels without a mesh, which come after the meshes, into the body's coarse spaces.
void take_coarse_spaces(Scene& scene) {
  const auto first = std::ranges::find_if(
      scene.levels, [](const LevelRecipe& level) { return level.coarsen.has_value(); });
  const auto meshes = first - scene.levels.begin();
  if (first == scene.levels.end()) return;
  const auto refuse = [&](std::ptrdiff_t level, const std::string& why) {
    throw InputError(fmt::format("body.levels.{}: {}", level, why));
  };
  if (meshes == 0)
    refuse(0, "coarsen makes coarse spaces of the mesh before it; expected a mesh first");
  std::vector<int>& sizes = scene.problem.body.coarsen.emplace();
  for (auto i = meshes; i < std::ssize(scene.levels); ++i) {
    const std::optional<int>& points = scene.levels[static_cast<std::size_t>(i)].coarsen;
    if (!points) refuse(i, "a mesh stands after coarsen; expected meshes first");
    if (*points == 0 && std::ssize(scene.levels) > meshes + 1)
      refuse(i,
             "coarsen is auto, which makes as many spaces as it takes; expected it alone, or "
             "numbers of points");
    if (*points > 0) sizes.push_back(*points);
  }
  scene.levels.erase(first, scene.levels.end());
}

/// Adds a level for each lattice.
void take_lattices(Scene& scene) {
  if (!scene.lattices) return;
  const std::vector<double>& sizes = scene.lattices->sizes;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (i > 0 && !(sizes[i] > sizes[i - 1]))
      throw InputError(
          fmt::format("body.levels.sizes.{} is {:g} m after {:g} m; expected larger "
                      "cells from level to level, finest first",
                      i, sizes[i], sizes[i - 1]));
    scene.levels.emplace_back().lattice = sizes[i];
  }
  if (scene.jitter > 0)
    throw InputError("body.jitter: the cells of a lattice stay cubes; remove this key");
}

}  // namespace

Scene read_scene(const Tree& tree) {
  Scene scene;
  scene.file = tree.where.file;
  scene.name = valid_utf8(std::filesystem::path(scene.file).stem().string());
  Reader reader({tree, ""});
  describe(reader, scene);
  reader.finish();
  with_places(tree, [&] {
    take_coarse_spaces(scene);
    take_lattices(scene);
  });
  for (const ObstacleRecipe& recipe : scene.obstacles) {
    ObstacleOptions& made = scene.problem.contact.obstacles.emplace_back(recipe.options);
    if (recipe.tool) made.shape = recipe.tool->options;
  }
  if (!scene.obstacles.empty() && !scene.surface && !scene.lattices && scene.bodies.empty())
    scene.surface.emplace().boundary = true;
  if (IntegrationOptions& o = scene.problem.integration; seeks_rest(o)) {
    if (!o.rest.ramp) o.rest.ramp = scene.duration;
    if (!scene.output.every) scene.output.every = Interval{0, 1};  // frames of all load steps
  }
  scene.source = tree;
  return scene;
}

namespace {

void only_of_files(const std::string& file, bool given, const std::string& path) {
  if (file.empty() && given) throw InputError(path + ": only a file has one");
}

// Throws InputError for young_modulus or poisson_ratio if the law does not use it. Every body has
// values of both, so the reader does not refuse them
void check_given(const Scene& scene, const Tree& tree) {
  const MaterialInfo& info = *find_material(scene.problem.body.material.model);
  std::vector<std::string> known;
  for (const MaterialParameter& p : info.parameters) known.emplace_back(p.name);
  const auto check = [&](const Tree* section, const std::string& path) {
    for (const MaterialParameter& p : {parameter::young_modulus, parameter::poisson_ratio})
      if (section && section->find(p.name) && std::ranges::find(known, p.name) == known.end())
        throw InputError(path + "." + p.name + ": " +
                             unknown_name("parameter of " + std::string(info.name), p.name, known),
                         place_of(tree, path + "." + p.name));
  };
  const Tree* body = tree.find("body");
  check(body->find("material"), "body.material");
  const Tree* regions = body->find("regions");
  for (const auto& [name, region] : scene.problem.body.regions)
    if (regions) check(regions->find(name), "body.regions." + name);
}

void check_body(const Scene& scene) {
  for (std::size_t i = 0; i < scene.levels.size(); ++i) {
    const LevelRecipe& level = scene.levels[i];
    const std::string path = fmt::format("body.levels.{}", i);
    only_of_files(level.file, level.scale != 1, path + ".scale");
    only_of_files(level.file, level.merge_duplicates.has_value(), path + ".merge_duplicates");
    only_of_files(level.file, level.repair, path + ".repair");
    only_of_files(level.file, !level.regions.empty(), path + ".regions");
    only_of_files(level.file, !level.leave_out.empty(), path + ".leave_out");
    only_of_files(level.file, level.order != LevelRecipe{}.order, path + ".order");
    if (level.refine && level.covers)
      throw InputError(path + " has refine and covers; expected one: refine chooses the part");
    if (!level.border.empty() && !level.covers)
      throw InputError(path + ".border: only a level with covers has one");
  }
  if (!scene.surface) return;
  const SurfaceRecipe& surface = *scene.surface;
  only_of_files(surface.file, surface.scale != 1, "body.surface.scale");
  if (!surface.sphere && !surface.boundary && surface.file.empty())
    throw InputError(
        "body.surface.boundary: expected true, got 'false'; leave body.surface out to have none");
}

// Returns the memory that the set-up of a generated level needs [bytes]. 350 bytes per tetrahedron
// were measured with `plica check` for 384 000 and for 1 296 000 tetrahedra
double generated_bytes(const LevelRecipe& level) {
  constexpr double bytes_per_tet = 350;
  const auto cells = [](int x, int y, int z) { return 6.0 * x * y * z * bytes_per_tet; };
  if (const auto& box = level.box) return cells(box->cells[0], box->cells[1], box->cells[2]);
  if (const auto& ball = level.ball) return cells(ball->cells, ball->cells, ball->cells);
  if (const auto& cylinder = level.cylinder)
    return cells(cylinder->across, cylinder->across, cylinder->along);
  if (const auto& blob = level.blob) return cells(blob->cells, blob->cells, blob->cells);
  if (const auto& tube = level.tube) return cells(tube->across, tube->around, tube->along);
  return 0;
}

double generated_bytes(const SurfaceRecipe& surface) {
  constexpr double bytes_per_triangle = 200;
  return surface.sphere ? 20 * std::pow(4.0, surface.sphere->subdivisions) * bytes_per_triangle : 0;
}

// Throws InputError if the set-up needs more memory than the machine has
void check_memory(const Scene& scene) {
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  double bytes = 0;
  const auto add = [&](double more, const std::string& path) {
    bytes += more;
    if (bytes > memory)
      throw InputError(fmt::format(
          "{}: a mesh this fine makes the scene take about {:.4g} GB of memory; this machine "
          "has {:.4g} GB",
          path, bytes / 1e9, memory / 1e9));
  };
  for (std::size_t i = 0; i < scene.levels.size(); ++i)
    add(generated_bytes(scene.levels[i]), fmt::format("body.levels.{}", i));
  if (scene.surface) add(generated_bytes(*scene.surface), "body.surface");
}

void check_output(const Scene& scene) {
  const OutputOptions& output = scene.output;
  if (output.probe_every && output.probes.empty())
    throw InputError("output.probe_every: there are no probes; give output.probes");
  for (const std::string& field : output.fields) {
    if (field == contact_pressure_field && scene.obstacles.empty() && !has_pairs(scene.problem))
      throw InputError("output.fields: " + field +
                       ": nothing touches the body; expected contact.obstacles");
    if (!is_of_surface(field) && !output.volume.all && output.volume.levels.empty())
      throw InputError("output.fields: " + field +
                       " is written with tetrahedra; expected output.volume");
  }
  const std::string& cycle = scene.problem.integration.cycle;
  const std::size_t levels = count_levels(scene.levels), in_use = integrated_levels(cycle, levels);
  for (const int level : output.volume.levels)
    if (static_cast<std::size_t>(level) >= in_use)
      throw InputError(
          fmt::format("output.volume: there is no level {}: the cycle '{}' integrates "
                      "{} of {} in body.levels, "
                      "counted from 0",
                      level, cycle, in_use, levels));
}

void check_duration(const Scene& scene) {
  constexpr double rounding = 1e-9;
  const std::optional<double>& step = scene.problem.integration.macro_step;
  if (step && *step > (1 + rounding) * scene.duration)
    throw InputError(
        fmt::format("integration.macro_step is {:g} s; expected at most the duration, {:g} s",
                    *step, scene.duration));
}

}  // namespace

double generated_bytes(const Scene& scene) {
  double bytes = scene.surface ? generated_bytes(*scene.surface) : 0;
  for (const LevelRecipe& level : scene.levels) bytes += generated_bytes(level);
  return bytes;
}

void check_scene(const Scene& scene, const Tree& tree) {
  const bool is_one = scene.bodies.empty();  // several bodies are checked one by one
  if (is_one) check_given(scene, tree);
  with_places(tree, [&] {
    if (is_one) {
      check_body(scene);
      check_memory(scene);
      validate_options(scene.problem, count_levels(scene.levels));
    }
    check_duration(scene);
    check_output(scene);
  });
}

namespace {

/// Checks that the probes lie in level 0. Throws InputError for a probe that is outside by more
/// than an edge. Adds a warning for one that is closer: the nearest point of the body is used.
void check_probes(Scene& scene) {
  if (scene.output.probes.empty()) return;
  const TetMesh& mesh = scene.problem.body.levels.front();
  const TetLocator locator(mesh);
  for (const auto& [name, point] : scene.output.probes) {
    const std::string path = "output.probes." + name;
    Embedding nearest;
    try {
      nearest = embed({point}, locator, Outside::clamp);
    } catch (const InputError& error) {
      throw InputError(path + ": " + error.what());
    }
    if (nearest.misses == 0) continue;
    const double distance = locator.locate(point).distance,
                 edges = nearest.largest_distance_over_edge;
    const std::string outside =
        fmt::format("{}: [{:g}, {:g}, {:g}] is {:.3g} m outside level 0 at rest", path, point.x(),
                    point.y(), point.z(), distance);
    if (edges > 1) {
      const Box box = bounding_box(mesh.vertices);
      throw InputError(fmt::format("{}, which lies in [{:g}, {:g}, {:g}] to [{:g}, {:g}, {:g}] m",
                                   outside, box.min.x(), box.min.y(), box.min.z(), box.max.x(),
                                   box.max.y(), box.max.z()));
    }
    scene.warnings.push_back(scene.file + ": " + outside + "; the nearest point of it is watched");
  }
}

/// Throws InputError where texture coordinates are to be written and there are none.
void check_texture(const Scene& scene) {
  const auto& surface = scene.problem.body.surface;
  if (scene.output.writes(texture_field) && (!surface || surface->texture.empty()))
    throw InputError(std::string("output.fields: ") + texture_field +
                     ": the body's surface has none; expected body.surface.file, an OBJ file with "
                     "lines 'vt'");
}

Scene load_body(const Tree& tree) {
  Scene scene = read_scene(tree);
  check_scene(scene, tree);
  build_meshes(scene, tree);
  return scene;
}

}  // namespace

Scene load_scene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Tree tree = read_tree(file);
  for (const Override& given : overrides) set_value(tree, given.assignment, given.label);
  return load_scene(tree);
}

Scene load_scene(const Tree& given) {
  Tree present = given;
  use_present_keys(present);
  const Tree tree = shared_integration(present);
  Scene scene = tree.find("bodies") != nullptr ? load_bodies(tree) : load_body(tree);
  with_places(tree, [&] {
    scene.bodies.empty() ? validate_meshes(scene.problem) : validate(scene.problem);
  });
  for (std::string& warning : warnings_of_older_keys(present))
    scene.warnings.push_back(std::move(warning));
  for (const std::string& doubt : problem_warnings(scene.problem))
    scene.warnings.push_back(scene.file + ": " + doubt);
  with_places(tree, [&] { check_probes(scene), check_texture(scene); });
  return scene;
}

}  // namespace plica::app
