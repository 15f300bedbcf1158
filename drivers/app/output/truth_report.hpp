// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/study/study.hpp>
#include <string>
#include <vector>

namespace plica::app {

inline constexpr std::size_t text_width = 110;  ///< columns of a study's text

/// Returns the columns of how the truth was found, for study.json and reference.bin.
const Table<Truth>& truth_columns();
/// Returns the columns of the error in space of each level with each kind of elements.
const Table<MeshReference>& mesh_columns();

/// Returns as text how the truth was found, how good it is, and the error of each mesh against it.
std::string truth_text(const StudyResult& result);

/// Wall time that a family of meshes needs for an error.
struct TimeForError {
  double seconds = 0;     ///< wall time [s]
  bool measured = false;  ///< true: measured; false: extrapolated
};
/// Returns the wall time that a family's meshes, each run by itself at its own limit, need for an
/// error. It is that of the first mesh with such an error. If no mesh has one, the time is
/// extrapolated from the two finest meshes as a power of the error. None: the error does not fall
/// from one of these to the other.
std::optional<TimeForError> time_for(const TruthFamily& family, double error);

}  // namespace plica::app
