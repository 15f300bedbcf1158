// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/study/study.hpp>

namespace plica::app {

/// What a study was of.
struct StudyHead {
  std::string scene, name;
  double duration = 0;  ///< [s]
  int samples = 0;
  std::vector<std::size_t> tets;               ///< of each level
  std::string digest;                          ///< studies with another are not gone on with
  std::vector<nlohmann::ordered_json> levels;  ///< see level_entries()
};

/// study.json; status: completed | interrupted | unfinished. `stopped`: the case that was
/// interrupted; empty: none.
std::string study_json(const StudyHead& head, const StudyMachine& machine,
                       const StudyResult& result, const std::string& status,
                       const std::string& stopped = {});

/// The rows of such a text; none where its digest is another, or it is none.
std::vector<StudyRow> rows_of_study(const std::string& json, const std::string& digest);

/// Whether such a text has rows with another digest.
bool holds_other_rows(const std::string& json, const std::string& digest);

/// study.csv: the rows, the same names as columns; what does not apply is empty.
std::string study_csv(const std::vector<StudyRow>& rows);

/// What a study found, for people: how good the reference is, the Pareto front, the fastest method
/// under 5, 1 and 0.1 % error, where a coarser mesh alone is enough, and what did not come to an
/// end or was left out.
std::string study_text(const Scene& scene, const StudyResult& result, const std::string& folder);

}  // namespace plica::app
