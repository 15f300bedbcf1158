// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/run/validate.hpp>
#include <string>

#include "target.hpp"

namespace plica::fuzz {

// All that happens to a scene before the set-up, its meshes too where they are small and generated
inline void scene(std::string_view bytes) {
  try {
    const app::Tree tree = app::parse_tree(std::string(bytes), "s.yaml");
    app::Scene scene = app::read_scene(tree);
    app::check_scene(scene, tree);
    if (scene.surface && !scene.surface->file.empty()) return;
    for (const app::LevelRecipe& level : scene.levels)
      if (!level.file.empty()) return;
    if (app::generated_bytes(scene) > 100e3) return;
    app::build_meshes(scene, tree);
    for (const TetMesh& mesh : scene.problem.body.levels) check(mesh);
    validate(scene.problem);
  } catch (const InputError&) {
  }
}

inline constexpr Target scene_targets[] = {{"scene", scene}};

}  // namespace plica::fuzz
