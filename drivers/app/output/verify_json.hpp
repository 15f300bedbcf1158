// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/this_machine.hpp>
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

}  // namespace plica::app
