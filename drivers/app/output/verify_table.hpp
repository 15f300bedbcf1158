// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/study/verify.hpp>
#include <string>

namespace plica::app {

/// What a table of known answers was made on.
struct VerifyHead {
  StudyMachine machine;
  std::string status;    ///< completed | interrupted | unfinished
  bool small = false;    ///< on coarser meshes
  double wall_time = 0;  ///< so far [s]
};

/// verify.json
std::string verify_json(const VerifyHead& head, const VerifyResult& result);

/// verify.csv: a line per row and mesh.
std::string verify_csv(const VerifyResult& result);

/// "finest", "limit" ...
std::string judged_name(Judged judged);

/// verify.md: one table with all there is to say, and what it was made on.
std::string verify_markdown(const VerifyHead& head, const VerifyResult& result);

/// The same in short, for a terminal; `folder` has the rest.
std::string verify_text(const VerifyResult& result, const std::string& folder);

}  // namespace plica::app
