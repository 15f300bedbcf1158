// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/study/study.hpp>

/// What a study's rows say.
namespace plica {

/// Sets `pareto` of every row: completed, and none is faster with an error as small, or as fast with a smaller one.
void mark_pareto(std::vector<StudyRow>& rows);

/// Small motions about rest grow by this cycle, by more than rounding and the uncertainty of what was found.
bool grows(const StudyRow& row);

/// The smallest error of the rows that are completed.
std::optional<double> smallest_error(const std::vector<StudyRow>& rows);

/// An error this small can be told: the reference's own is at most a tenth of it.
bool resolves(const StudyReference& reference, double error);

/// Every error reported can be told.
bool good_enough(const StudyResult& result);

/// The fastest completed row with an error below this, null where there is none.
const StudyRow* fastest_below(const std::vector<StudyRow>& rows, double error);

}  // namespace plica
