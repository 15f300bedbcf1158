// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <optional>
#include <plica/drivers/app/output/growing_file.hpp>
#include <plica/drivers/app/output/snapshot.hpp>

namespace plica::app {

/// Mass at each vertex of a level: a quarter of every tetrahedron around it. [kg]
std::vector<double> vertex_masses(const Body& body, int level = 0);

/// history.csv: energies, centre of mass and speeds of level 0, a row per output time; where bad macro steps are retried, how often
/// one was halved so far.
class History {
 public:
  /// Starts the file, or goes on after its first `kept` bytes.
  History(const std::filesystem::path& file, std::vector<double> masses, bool retries,
          std::optional<std::uint64_t> kept = {});
  void write(const Snapshot& snapshot);
  const GrowingFile& file() const { return file_; }

 private:
  GrowingFile file_;
  std::vector<double> masses_;
  bool retries_;
};

}  // namespace plica::app
