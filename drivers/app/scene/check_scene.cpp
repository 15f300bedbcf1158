// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <numeric>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/solver/registry.hpp>

namespace plica::app {
namespace {

void check_lengths(const IntegrationOptions& integration, std::size_t levels, const Tree& tree) {
  const auto check = [&](const char* key, std::size_t size, bool one_for_all) {
    if (size == levels || (size == 1 && one_for_all)) return;
    throw InputError(fmt::format("{}: expected {}{} ({} in body.levels), got a list of {}", key,
                                 one_for_all ? "one for all or " : "", "one for each level", levels, size),
                     place_of(tree, key));
  };
  check("integration.integrator", integration.integrator.size(), true);
  check("integration.substeps", integration.substeps.size(), true);
  if (integration.distribution == "custom") check("integration.distribution", integration.shares.size(), false);
}

void check_shares(const IntegrationOptions& integration, const Tree& tree) {
  if (integration.distribution != "custom") return;
  const double sum = std::accumulate(integration.shares.begin(), integration.shares.end(), 0.0);
  if (std::abs(sum - 1) > 1e-12)
    throw InputError(fmt::format("integration.distribution: the shares must add up to 1, got {:.15g}", sum),
                     place_of(tree, "integration.distribution"));
}

void check_contact(const Scene& scene, const Tree& tree) {
  const ContactOptions& contact = scene.problem.contact;
  if (!contact.obstacles.empty() && !scene.surface)
    throw InputError("contact.obstacles: the body has no surface to touch them; give body.surface",
                     place_of(tree, "contact.obstacles"));
  for (std::size_t i = 0; i < contact.obstacles.size(); ++i) {
    const std::string path = fmt::format("contact.obstacles.{}", i);
    if (const auto* bowl = std::get_if<BowlOptions>(&contact.obstacles[i].shape); bowl && bowl->rim > bowl->radius)
      throw InputError(
          fmt::format("{}.bowl.rim: expected at most the radius ({:g} m), got {:g} m", path, bowl->radius, bowl->rim),
          place_of(tree, path + ".bowl.rim"));
    if (const auto* plane = std::get_if<PlaneOptions>(&contact.obstacles[i].shape); plane && plane->normal.isZero(0))
      throw InputError(path + ".plane.normal: expected a direction, got [0, 0, 0]",
                       place_of(tree, path + ".plane.normal"));
  }
}

void check_box(const Selection& selection, const std::string& path, const Tree& tree) {
  const Box* box = std::get_if<Box>(&selection);
  if (box && (box->min.array() > box->max.array()).any())
    throw InputError(path + ".box: min is above max", place_of(tree, path + ".box"));
}

void only_of_files(const std::string& file, bool given, const std::string& path, const Tree& tree) {
  if (file.empty() && given) throw InputError(path + ": only a file has one", place_of(tree, path));
}

void check_body(const Scene& scene, const Tree& tree) {
  const Body& body = scene.problem.body;
  for (std::size_t i = 0; i < body.fixed.size(); ++i) check_box(body.fixed[i], fmt::format("body.fixed.{}", i), tree);
  for (std::size_t i = 0; i < body.prescribed.size(); ++i)
    check_box(body.prescribed[i].where, fmt::format("body.prescribed.{}", i), tree);
  for (std::size_t i = 0; i < scene.levels.size(); ++i) {
    const LevelRecipe& level = scene.levels[i];
    const std::string path = fmt::format("body.levels.{}", i);
    only_of_files(level.file, level.scale != 1, path + ".scale", tree);
    only_of_files(level.file, level.merge_duplicates.has_value(), path + ".merge_duplicates", tree);
  }
  if (!scene.surface) return;
  const SurfaceRecipe& surface = *scene.surface;
  only_of_files(surface.file, surface.scale != 1, "body.surface.scale", tree);
  if (!surface.sphere && !surface.boundary && surface.file.empty())
    throw InputError("body.surface.boundary: expected true, got 'false'; leave body.surface out to have none",
                     place_of(tree, "body.surface.boundary"));
}

// What a set-up takes of memory [bytes]. Measured with `plica check`: 350 for each of 384 000 and of 1 296 000
// tetrahedra
double generated_bytes(const LevelRecipe& level) {
  constexpr double bytes_per_tet = 350;
  const auto cells = [](int x, int y, int z) { return 6.0 * x * y * z * bytes_per_tet; };
  if (const auto& box = level.box) return cells(box->cells[0], box->cells[1], box->cells[2]);
  if (const auto& ball = level.ball) return cells(ball->cells, ball->cells, ball->cells);
  if (const auto& cylinder = level.cylinder) return cells(cylinder->across, cylinder->across, cylinder->along);
  return 0;
}

double generated_bytes(const SurfaceRecipe& surface) {
  constexpr double bytes_per_triangle = 200;
  return surface.sphere ? 20 * std::pow(4.0, surface.sphere->subdivisions) * bytes_per_triangle : 0;
}

// Nothing is allocated that cannot be had
void check_memory(const Scene& scene, const Tree& tree) {
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  double bytes = 0;
  const auto add = [&](double more, const std::string& path) {
    bytes += more;
    if (bytes > memory)
      throw InputError(fmt::format("{}: a mesh this fine makes the scene take about {:.4g} GB of memory; this machine "
                                   "has {:.4g} GB",
                                   path, bytes / 1e9, memory / 1e9),
                       place_of(tree, path));
  };
  for (std::size_t i = 0; i < scene.levels.size(); ++i)
    add(generated_bytes(scene.levels[i]), fmt::format("body.levels.{}", i));
  if (scene.surface) add(generated_bytes(*scene.surface), "body.surface");
}

void check_output(const Scene& scene, const Tree& tree) {
  const OutputOptions& output = scene.output;
  if (output.probe_every && output.probes.empty())
    throw InputError("output.probe_every: there are no probes; give output.probes",
                     place_of(tree, "output.probe_every"));
  const std::string& cycle = scene.problem.integration.cycle;
  const std::size_t in_use = integrates_coarse_levels(cycle) ? scene.levels.size() : 1;
  for (const int level : output.volume.levels)
    if (static_cast<std::size_t>(level) >= in_use)
      throw InputError(
          fmt::format("output.volume: there is no level {}: the cycle '{}' integrates {} of {} in body.levels, "
                      "counted from 0",
                      level, cycle, in_use, scene.levels.size()),
          place_of(tree, "output.volume"));
}

}  // namespace

double generated_bytes(const Scene& scene) {
  double bytes = scene.surface ? generated_bytes(*scene.surface) : 0;
  for (const LevelRecipe& level : scene.levels) bytes += generated_bytes(level);
  return bytes;
}

void check_scene(const Scene& scene, const Tree& tree) {
  check_body(scene, tree);
  check_memory(scene, tree);
  check_lengths(scene.problem.integration, scene.levels.size(), tree);
  check_shares(scene.problem.integration, tree);
  check_contact(scene, tree);
  check_output(scene, tree);
}

}  // namespace plica::app
