// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/drivers/app/output/vtu.hpp>

namespace plica::app {

/// A film: one file per point in time in the folder `frames`, and beside it the collection that viewers open. After
/// every frame the collection on disk names the frames that are there.
class Frames {
 public:
  /// Writes folder/frames/NAME_0000.vtu ... and folder/COLLECTION; removes those of a former run.
  Frames(std::filesystem::path folder, std::string name, std::string collection);
  void write(const VtuGrid& grid);
  std::size_t count() const { return entries_; }

 private:
  std::filesystem::path folder_;
  std::string name_, collection_, list_;
  std::size_t entries_ = 0;
};

}  // namespace plica::app
