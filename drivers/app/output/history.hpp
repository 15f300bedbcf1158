// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/drivers/app/output/snapshot.hpp>

namespace plica::app {

/// Mass at each vertex of level 0: a quarter of every tetrahedron around it. [kg]
std::vector<double> vertex_masses(const Body& body);

/// history.csv: energies, centre of mass and speeds of level 0, a row per output time.
class History {
 public:
  History(std::filesystem::path file, std::vector<double> masses);
  void write(const Snapshot& snapshot);

 private:
  std::filesystem::path file_;
  std::vector<double> masses_;
  std::string text_;
};

}  // namespace plica::app
