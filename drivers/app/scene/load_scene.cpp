// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/reader.hpp>

namespace plica::app {

std::vector<Choice> outside_rules() {
  return {{"clamp", "moves with the nearest point of the other mesh"},
          {"extrapolate", "continues the nearest tetrahedron"},
          {"keep", "keeps its own motion"}};
}

std::vector<Choice> frame_formats() { return {{"vtu", "VTK's XML format for unstructured grids"}}; }

Scene read_scene(const Tree& tree) {
  Scene scene;
  scene.file = tree.where.file;
  scene.name = std::filesystem::path(scene.file).stem().string();
  Reader reader({tree, ""});
  describe(reader, scene);
  reader.finish();
  return scene;
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
  check_probes(scene, tree);
  scene.as_written = tree;
  return scene;
}

}  // namespace plica::app
