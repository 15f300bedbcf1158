// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/drivers/study/study.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Row of a study that is chosen for an error class. It is the fastest row whose error, together
/// with that of the reference, is below the allowed one. The choice fixes elements, mesh, stepper
/// (explicit or implicit) and step at once. If the study is against the truth, it is made by total
/// error.
struct StudyChoice {
  std::string error_class;
  double allowed = 0;             ///< error that the class allows, as a fraction
  const StudyRow* row = nullptr;  ///< the chosen row; null: no row is as good
  std::string reason;             ///< why this row was chosen, in sentences
};
/// Returns the choice for each error class.
std::vector<StudyChoice> choices_of(const StudyResult& result);

/// Returns the entries of a scene's body.levels as JSON; empty if body.levels is no list.
std::vector<nlohmann::ordered_json> level_entries(const Tree& scene);

/// Returns the choices as study.json has them. Each has the settings, as --set takes them, with
/// which a run of the scene is the chosen row. They are null for variants, for coarser meshes
/// without an entry in `levels`, and where no row was chosen.
/// @param levels  see level_entries()
nlohmann::ordered_json choices_json(const StudyResult& result,
                                    const std::vector<nlohmann::ordered_json>& levels);

/// Returns the settings that the study in a folder has chosen for the scene's error class. Throws
/// InputError if there is no study, if it is of another scene, or if it has no choice for the
/// class.
std::vector<Override> settings_of_study(const std::filesystem::path& folder,
                                        const std::filesystem::path& scene,
                                        const std::vector<Override>& overrides);

}  // namespace plica::app
