// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/terminal.hpp>

namespace plica::app {

KokkosSession::KokkosSession(const KokkosArguments& arguments) {
  // Kokkos warns where OpenMP's threads are not bound. Binding is the user's choice, and comes too late from here.
  setenv("OMP_PROC_BIND", "false", 0);
  std::vector<std::string> words = {"plica"};
  words.insert(words.end(), arguments.pass_through.begin(), arguments.pass_through.end());
  if (arguments.threads > 0) words.push_back("--kokkos-num-threads=" + std::to_string(arguments.threads));
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int count = static_cast<int>(words.size());
  Kokkos::initialize(count, pointers.data());
}

std::vector<LevelReport> in_input_numbers(std::vector<LevelReport> levels, const Scene& scene) {
  for (std::size_t i = 0; i < levels.size(); ++i)
    for (StiffElement& e : levels[i].stiffest) e.element = input_number(scene.numbering[i].tet_ids, e.element);
  return levels;
}

SubstepRefused in_input_numbers(const SubstepRefused& error, const Scene& scene) {
  std::optional<StiffElement> element = error.element;
  const auto& ids = scene.numbering[static_cast<std::size_t>(error.level)].tet_ids;
  if (element) element->element = input_number(ids, element->element);
  return {error.words, error.level, element};
}

Scene loaded(const SceneArguments& arguments, SetUpProgress& progress) {
  progress.phase("reading the scene and its meshes");
  Scene scene = load_scene(arguments.scene, arguments.overrides);
  warn(scene);
  return scene;
}

void warn(const Scene& scene) {
  for (const std::string& warning : scene.warnings) message(coloured("warning: ", Colour::yellow) + warning);
}

}  // namespace plica::app
