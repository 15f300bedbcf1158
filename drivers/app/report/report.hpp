// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace plica::app {

/// A page that shows what `plica run` or `plica study` left in a folder.
struct Report {
  /// all of it: it opens without other files and without a network
  std::string html;
  std::size_t frames = 0;        ///< on the page
  std::size_t frames_there = 0;  ///< that the run wrote
  /// what is missing or cannot be read, a sentence each; the page shows them too
  std::vector<std::string> warnings;
};

/// At most `frames` of a run are taken, evenly, the first and the last among them. InputError where
/// the folder holds neither a run nor a study, or a file of it is damaged; a frame that is missing
/// or damaged is left out, with a warning.
Report make_report(const std::filesystem::path& folder, std::size_t frames);

}  // namespace plica::app
