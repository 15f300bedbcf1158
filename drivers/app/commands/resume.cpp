// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/commands/resume.hpp>
#include <plica/drivers/app/scene/tree_json.hpp>
#include <stdexcept>

namespace plica::app {

Scene scene_to_resume(const RunArguments& arguments, const Checkpoint& from) {
  if (!arguments.precision.empty() && arguments.precision != from.precision)
    throw InputError("cannot resume in " + arguments.precision + ": the run is in " + from.precision);
  Tree tree = arguments.scene.empty() ? from.scene : read_tree(arguments.scene);
  for (const Override& given : arguments.overrides) override_value(tree, given.assignment, given.label);
  if (const std::string difference = first_difference(from.scene, tree, "duration"); !difference.empty())
    throw InputError("cannot resume another scene: " + difference + "; only the duration may change");
  Scene scene = load_scene(tree);
  if (mesh_digest(scene.problem.body) != from.meshes)
    throw InputError("cannot resume: the meshes are not those of the run; has a mesh file changed?", {from.scene_file});
  scene.file = from.scene_file;
  return scene;
}

Interval checkpoint_interval(const std::string& text) {
  const std::string expected =
      "--checkpoint: expected every=N macro steps or every=TIME, such as every=100 or every=0.1s, got '" + text + "'";
  if (!text.starts_with("every=")) throw InputError(expected);
  const std::string interval = text.substr(6);
  const bool digits = !interval.empty() && interval.find_first_not_of("0123456789") == std::string::npos;
  try {
    return parse_interval(digits ? interval + " steps" : interval);
  } catch (const std::invalid_argument& problem) {
    throw InputError(expected + ", " + problem.what());
  }
}

}  // namespace plica::app
