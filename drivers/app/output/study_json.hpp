// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/this_machine.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/study/study.hpp>

namespace plica::app {

/// What a study was of.
struct StudyHead {
  std::string scene, name;
  double duration = 0;  ///< [s]
  int samples = 0;
  std::vector<std::size_t> tets;  ///< of each level
  std::string digest;             ///< studies with another are not gone on with
};

/// study.json; status: completed | interrupted | unfinished.
std::string study_json(const StudyHead& head, const StudyMachine& machine, const StudyResult& result,
                       const std::string& status);

/// The rows of such a text; none where its digest is another, or it is none.
std::vector<StudyRow> rows_of_study(const std::string& json, const std::string& digest);

/// study.csv: the rows, the same names as columns; what does not apply is empty.
std::string study_csv(const std::vector<StudyRow>& rows);

}  // namespace plica::app
