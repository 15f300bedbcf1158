// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/frames.hpp>
#include <plica/drivers/app/output/history.hpp>
#include <plica/drivers/app/scene/scene.hpp>

namespace plica::app {

/// What a run leaves in its folder while it goes on: frames and history. A former run's files there give way.
class RunFiles {
 public:
  RunFiles(const Scene& scene, const std::filesystem::path& folder);
  void write(const Snapshot& snapshot);
  std::size_t frames() const { return surface_frames_.count(); }
  double last_time() const { return last_time_; }  ///< of what is on disk [s]

 private:
  void write_surface(const Snapshot& snapshot);
  void write_volume(const Snapshot& snapshot);

  const Numbering& numbering_;    // of level 0
  TetMesh finest_;                // level 0 as the input has it
  Point placement_;               // the body's translation at the start [m]
  TriangleSurface skin_;          // the embedded surface, else the boundary of level 0, at rest
  std::vector<int> skin_vertex_;  // of that boundary: its vertices' numbers in level 0
  Frames surface_frames_;
  std::optional<Frames> volume_frames_;
  History history_;
  double last_time_ = 0;
};

}  // namespace plica::app
