// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/drivers/app/output/growing_file.hpp>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/solver/material_points.hpp>
#include <plica/drivers/solver/simulation.hpp>

namespace plica::app {

std::vector<std::string> names_of(const std::map<std::string, Point>& probes);
std::vector<Point> points_of(const std::map<std::string, Point>& probes);

/// "time,tip_x,tip_y,tip_z,tip_vx,tip_vy,tip_vz" and a row of it.
std::string probe_head(const std::vector<std::string>& names);
std::string probe_row(double time, const std::vector<Point>& positions, const std::vector<Point>& velocities);

/// probes.csv: positions and velocities of the scene's probes, by name.
template <class B>
class Probes {
 public:
  /// Starts the file, or goes on after its first `kept` bytes.
  Probes(const Scene& scene, const std::filesystem::path& file, std::optional<std::uint64_t> kept = {})
      : points_(scene.problem.body.levels.front(), points_of(scene.output.probes)),
        placement_(placement_of(scene.problem.body)),
        file_(kept ? GrowingFile(file, *kept) : GrowingFile(file, probe_head(names_of(scene.output.probes)))) {}

  void write(const Simulation<B>& simulation, double time) {
    auto [positions, velocities] = points_.sample({}, simulation.displacement(), simulation.velocity());
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += points_.rest()[i] + placement_;
    file_.add(probe_row(time, positions, velocities));
  }
  const GrowingFile& file() const { return file_; }

 private:
  MaterialPoints<B> points_;
  Point placement_;
  GrowingFile file_;
};

}  // namespace plica::app
