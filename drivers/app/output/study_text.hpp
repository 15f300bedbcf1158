// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/study/study.hpp>

namespace plica::app {

/// What a study found, for people: how good the reference is, the Pareto front, the fastest method under 5, 1 and 0.1 % error, where a
/// coarser mesh alone is enough, and what did not come to an end or was left out.
std::string study_text(const Scene& scene, const StudyResult& result, const std::string& folder);

}  // namespace plica::app
