// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/drivers/app/output/frames.hpp>
#include <plica/drivers/app/output/history.hpp>
#include <plica/drivers/app/scene/scene.hpp>

namespace plica::app {

/// How far a run's files are: what a checkpoint remembers of them.
struct FilesMark {
  std::vector<double> frame_times;  ///< [s]
  std::uint64_t history_bytes = 0, probe_bytes = 0;
};

/// Where the body's rest mesh is at the start: its translation. [m]
Point placement_of(const Body& body);

/// What a run leaves in its folder while it goes on: frames and history. A former run's files there give way, or are cut
/// back to the mark of the checkpoint from which this run goes on.
class RunFiles {
 public:
  RunFiles(const Scene& scene, const std::filesystem::path& folder, const std::optional<FilesMark>& from = {});
  /// Writes the volumes that volumes() names, and all else.
  void write(const Snapshot& snapshot);
  const std::vector<int>& volumes() const { return volume_levels_; }
  std::size_t frames() const { return frame_times_.size(); }
  double last_time() const { return frame_times_.empty() ? 0 : frame_times_.back(); }  ///< of what is on disk [s]
  FilesMark mark() const { return {frame_times_, history_.file().size(), 0}; }
  /// Waits until all of it is on the disk.
  void sync();

 private:
  struct Volume {  // a written level: what stays the same, in input order
    TetMesh mesh;
    std::vector<double> mass;
  };
  VtuGrid surface_grid(const Snapshot& snapshot) const;
  VtuGrid volume_grid(const VolumeSnapshot& volume, const Volume& constant, double time) const;

  Body body_;                                // with the regions that are selected
  const std::vector<Numbering>& numbering_;  // of its levels
  Point placement_;
  TriangleSurface skin_;          // the embedded surface, else the boundary of level 0, at rest
  std::vector<int> skin_vertex_;  // of that boundary: its vertices' numbers in level 0
  std::vector<int> volume_levels_;
  std::vector<Volume> volumes_;
  std::vector<double> frame_times_;
  Frames surface_frames_;
  std::vector<Frames> volume_frames_;
  History history_;
};

}  // namespace plica::app
