// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/reader.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>

namespace plica::app {

std::vector<Choice> outside_rules() {
  return {{"clamp", "moves with the nearest point of the other mesh"},
          {"extrapolate", "continues the nearest tetrahedron"},
          {"keep", "keeps its own motion"}};
}

std::vector<Choice> frame_formats() { return {{"vtu", "VTK's XML format for unstructured grids"}}; }

std::vector<Choice> precisions() { return {{"float", "32 bits"}, {"double", "64 bits"}}; }

Scene read_scene(const Tree& tree) {
  Scene scene;
  scene.file = tree.where.file;
  scene.name = std::filesystem::path(scene.file).stem().string();
  Reader reader({tree, ""});
  describe(reader, scene);
  reader.finish();
  for (const ObstacleRecipe& recipe : scene.obstacles) {
    ObstacleOptions& made = scene.problem.contact.obstacles.emplace_back(recipe.options);
    if (recipe.tool) made.shape = SurfaceOptions{{}, recipe.tool->cells};
  }
  scene.source = tree;
  return scene;
}

InputError located(const InputError& error, const Tree& source) {
  const std::string message = error.what(), option = message.substr(0, message.find_first_of(" :,"));
  const bool named = source.find(option.substr(0, option.find('.'))) != nullptr;
  return InputError(message, named ? place_of(source, option) : Where{source.where.file, 0});
}

Scene load_scene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Tree tree = read_tree(file);
  for (const Override& given : overrides) override_value(tree, given.assignment, given.label);
  return load_scene(tree);
}

Scene load_scene(const Tree& tree) {
  Scene scene = read_scene(tree);
  check_scene(scene, tree);
  build_meshes(scene, tree);
  try {
    validate(scene.problem);
  } catch (const InputError& error) {
    throw located(error, tree);
  }
  for (const std::string& doubt : doubts(scene.problem)) scene.warnings.push_back(scene.file + ": " + doubt);
  check_probes(scene, tree);
  return scene;
}

}  // namespace plica::app
