// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica::app {

void check_probes(Scene& scene, const Tree& tree) {
  if (scene.output.probes.empty()) return;
  const TetMesh& mesh = scene.problem.body.levels.front();
  const TetLocator locator(mesh);
  for (const auto& [name, point] : scene.output.probes) {
    const std::string path = "output.probes." + name;
    Embedding nearest;
    try {
      nearest = embed({point}, locator, Outside::clamp);
    } catch (const InputError& error) {
      throw InputError(path + ": " + error.what(), place_of(tree, path));
    }
    if (nearest.misses == 0) continue;
    const double distance = locator.locate(point).distance, edges = nearest.largest_distance_over_edge;
    const std::string outside = fmt::format("{}: [{:g}, {:g}, {:g}] is {:.3g} m outside level 0 at rest", path,
                                            point.x(), point.y(), point.z(), distance);
    if (edges > 1) {
      const Box box = bounding_box(mesh.vertices);
      throw InputError(fmt::format("{}, which lies in [{:g}, {:g}, {:g}] to [{:g}, {:g}, {:g}] m", outside, box.min.x(),
                                   box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()),
                       place_of(tree, path));
    }
    scene.warnings.push_back(scene.file + ": " + outside + "; the nearest point of it is watched");
  }
}

}  // namespace plica::app
