// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/load_scene.hpp>
#include <string>

namespace plica::app::test {

/// A sound scene of two levels, on which tests do their damage.
inline const std::string sound_scene = R"(duration: 1 s
gravity: [0, 0, -9.81]
body:
  levels:
    - {box: {size: [0.1, 0.1, 0.1], cells: [4, 4, 4]}}
    - {box: {size: [10 cm, 10 cm, 10 cm], cells: [2, 2, 2]}}
  material: {model: neo_hookean, young_modulus: 50 kPa}
  surface: {sphere: {radius: 4 cm, subdivisions: 1}}
integration:
  cycle: rsv
  macro_step: 1 ms
contact:
  obstacles:
    - {plane: {point: [0, 0, -0.1]}, friction: 0.2}
)";

inline Scene scene_of(const std::string& text, const std::vector<std::string>& sets = {}) {
  Tree tree = parse_tree(text, "a.yaml");
  for (const std::string& set : sets) override_value(tree, set, "--set " + set);
  Scene scene = read_scene(tree);
  check_scene(scene, tree);
  build_meshes(scene, tree);
  return scene;
}

/// What is said of the scene; "no error" when it is sound.
inline std::string error_of(const std::string& text, const std::vector<std::string>& sets = {}) {
  try {
    scene_of(text, sets);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The sound scene with one piece of its text replaced.
inline std::string damaged(const std::string& piece, const std::string& replacement) {
  std::string text = sound_scene;
  return text.replace(text.find(piece), piece.size(), replacement);
}

}  // namespace plica::app::test
