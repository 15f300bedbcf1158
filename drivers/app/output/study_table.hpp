// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/study/study.hpp>

namespace plica::app {

/// Scene and options of a study, as study.json states them.
struct StudyHead {
  std::string scene, name;
  double duration = 0;                         ///< simulated time [s]
  int samples = 0;                             ///< number of times at which states are compared
  std::vector<std::size_t> tets;               ///< number of tetrahedra of each level
  std::string digest;                          ///< a study with another digest is not continued
  std::vector<nlohmann::ordered_json> levels;  ///< see level_entries()
};

/// Returns the contents of study.json.
/// @param status   completed | interrupted | unfinished
/// @param stopped  key of the case that was interrupted; empty: none
std::string study_json(const StudyHead& head, const StudyMachine& machine,
                       const StudyResult& result, const std::string& status,
                       const std::string& stopped = {});

/// Returns the rows in the contents of study.json; none if its digest differs or it is damaged.
std::vector<StudyRow> rows_of_study(const std::string& json, const std::string& digest);

/// Returns true if the contents of study.json have rows and another digest.
bool holds_other_rows(const std::string& json, const std::string& digest);

/// Returns the contents of study.csv: columns named as in study.json; empty: does not apply.
std::string study_csv(const std::vector<StudyRow>& rows);

/// Returns the results of a study as text: how good the reference is and the Pareto front. Then the
/// fastest method under 5, 1 and 0.1 % error, and whether a coarser mesh alone is enough for it.
/// Then the cases that did not complete or were left out.
std::string study_text(const Scene& scene, const StudyResult& result, const std::string& folder);

}  // namespace plica::app
