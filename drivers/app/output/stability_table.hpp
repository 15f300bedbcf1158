// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/study/stability.hpp>
#include <plica/drivers/study/stability_matrix.hpp>

namespace plica::app {

/// Contents of stability.json and stability.csv.
struct StabilityTexts {
  std::string json, csv;
};

/// Returns the files' contents for a scene's methods; status: completed | interrupted | unfinished.
StabilityTexts stability_texts(const Scene& scene, const StudyMachine& machine,
                               const StabilityResult& result, const std::string& status);

/// Returns the files' contents for the matrix; status: completed | interrupted | unfinished.
StabilityTexts stability_texts(const StudyMachine& machine, const MatrixResult& result,
                               const std::string& status);

/// Returns the results for a scene's methods as text; the files are in `folder`.
std::string stability_text(const Scene& scene, const StabilityResult& result,
                           const std::string& folder);

/// Returns the results of the matrix as text: counts, and every row that is wrong.
std::string stability_text(const MatrixResult& result, const std::string& folder);

}  // namespace plica::app
