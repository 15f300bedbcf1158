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

/// What of a study to take for an error class: its fastest row whose error, with that of the
/// reference, is below what the class allows. Elements, mesh, stepper, explicit or implicit, and
/// step are chosen at once, by total error where the study is against the truth.
struct StudyChoice {
  std::string error_class;
  double allowed = 0;
  const StudyRow* row = nullptr;  ///< none: no row is as good
  std::string reason;             ///< why that one, in sentences
};
std::vector<StudyChoice> choices_of(const StudyResult& result);

/// The entries of body.levels as a scene has them; empty where they are no list.
std::vector<nlohmann::ordered_json> level_entries(const Tree& scene);

/// In study.json; `levels`: see level_entries(). Each has the settings that make a run of the scene
/// that row, as --set takes them; null where there are none, for variants, and for coarser meshes
/// that have no entry.
nlohmann::ordered_json choices_json(const StudyResult& result,
                                    const std::vector<nlohmann::ordered_json>& levels);

/// Those of the study in a folder for the error class that the scene asks for. InputError where
/// there is no such study, it is of another scene, or has found nothing within that class.
std::vector<Override> settings_of_study(const std::filesystem::path& folder,
                                        const std::filesystem::path& scene,
                                        const std::vector<Override>& overrides);

}  // namespace plica::app
