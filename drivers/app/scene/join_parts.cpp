// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/scene/join_parts.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/run/compose_levels.hpp>

namespace plica::app {

void join_parts(Scene& scene, const Tree& tree) {
  Body& body = scene.problem.body;
  std::vector<Numbering> numbering;
  for (std::size_t i = 0; i < scene.levels.size(); ++i) {
    const LevelRecipe& recipe = scene.levels[i];
    const bool joined = i > 0 && is_part(scene.levels[i - 1]);
    if (!is_part(recipe)) numbering.push_back(joined ? Numbering{} : scene.numbering[i]);
    if (!is_part(recipe)) continue;
    LevelCover& cover = body.covers[i] = recipe.covers.value_or(LevelCover{});
    cover.border = recipe.border;
    if (!recipe.refine) continue;
    cover.refined = true, cover.follows = recipe.refine->follows;
    if (!cover.follows) cover.where = recipe.refine->where;
  }
  if (body.covers.empty()) return;
  scene.numbering = std::move(numbering);
  try {
    for (const std::string& doubt : compose_levels(body, scene.problem.contact))
      scene.warnings.push_back(scene.file + ": " + doubt);
  } catch (const InputError& error) {
    throw located(error, tree);
  }
}

}  // namespace plica::app
