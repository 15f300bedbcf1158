// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace plica::app {

/// Page that shows a run or a study.
struct Report {
  /// the whole page: it needs no other files and no network
  std::string html;
  std::size_t frames = 0;        ///< number of frames on the page
  std::size_t frames_there = 0;  ///< number of frames that the run wrote
  /// warnings about what is missing or cannot be read, one sentence each; the page shows them too
  std::vector<std::string> warnings;
};

/// Makes the page of a folder that `plica run` or `plica study` wrote. Takes at most `frames`
/// frames of a run, evenly, the first and the last among them. Leaves out frames that are missing
/// or damaged, with a warning. Throws InputError if the folder holds neither a run nor a study, or
/// if another file is damaged.
Report make_report(const std::filesystem::path& folder, std::size_t frames);

}  // namespace plica::app
