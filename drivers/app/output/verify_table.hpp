// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/study/verify.hpp>
#include <string>

namespace plica::app {

/// Conditions under which a table of problems with known solutions was made.
struct VerifyHead {
  StudyMachine machine;
  std::string status;    ///< completed | interrupted | unfinished
  bool small = false;    ///< true: on coarser meshes
  double wall_time = 0;  ///< wall time so far [s]
};

/// Returns the contents of verify.json.
std::string verify_json(const VerifyHead& head, const VerifyResult& result);

/// Returns the contents of verify.csv: a line per row and mesh.
std::string verify_csv(const VerifyResult& result);

/// Returns the contents of verify.md: a table of all data, and the conditions it was made under.
std::string verify_markdown(const VerifyHead& head, const VerifyResult& result);

/// Returns a short table for a terminal; verify.md in `folder` has all data.
std::string verify_text(const VerifyResult& result, const std::string& folder);

}  // namespace plica::app
