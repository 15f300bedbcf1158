// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json.hpp>
#include <plica/drivers/study/study.hpp>
#include <string>
#include <vector>

namespace plica::app {

inline constexpr std::size_t text_width = 110;  ///< of a study's sentences

/// "0.123 %"
std::string percent(double fraction);

/// In study.json and reference.bin: how the truth was found.
nlohmann::ordered_json truth_json(const Truth& truth);
Truth truth_of(const nlohmann::ordered_json& json);  ///< the same, read

/// Of each kind of elements and level its error in space; without the motion.
nlohmann::ordered_json meshes_json(const std::vector<MeshReference>& meshes);
std::vector<MeshReference> meshes_of(const nlohmann::ordered_json& json);  ///< the same, read

/// For people: how the truth was found, how good it is, and what each mesh is off it.
std::string truth_text(const StudyResult& result);

/// The wall time that a family's meshes, each run by itself at its own limit, need for so small an
/// error: as measured where one is as good, else extrapolated, as a power of the error, from the
/// two finest; none where it does not fall from one to the other.
struct TimeForError {
  double seconds = 0;
  bool measured = false;
};
std::optional<TimeForError> time_for(const TruthFamily& family, double error);

}  // namespace plica::app
