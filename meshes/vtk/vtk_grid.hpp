// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/numbers.hpp>
#include <plica/meshes/raw_mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// A number of a file and where it is.
struct PlacedInteger {
  std::int64_t value = 0;
  Place place;
};
std::vector<PlacedInteger> read_integers(std::int64_t count, NumberType type, std::string_view what, Numbers& numbers);

/// An unstructured grid, as both formats of VTK hold it. Points and cells count from 0.
struct VtkGrid {
  std::string file;
  std::vector<RawVertex> points;
  std::vector<PlacedInteger> connectivity;  ///< the points of cell after cell
  std::vector<PlacedInteger> ends;          ///< per cell where it ends in `connectivity`
  std::vector<PlacedInteger> types;         ///< per cell
  std::string region_array;                 ///< the name of that one of the cells' arrays; empty: there is none
  std::vector<PlacedInteger> regions;       ///< per cell

  void read_points(std::int64_t count, NumberType type, Numbers& numbers);
  /// Reads an array of the cells, from numbers or past them: the one named "region" tells the regions, else the first
  /// one of an integer per cell.
  void read_cell_data(const std::string& name, std::int64_t tuples, std::int64_t components, NumberType type,
                      Numbers& numbers);
  /// Checks that the parts fit each other. Tetrahedra are kept, what is of lower dimension counted and checked; region
  /// 3 of the array "region" is named "region_3", and where all are 0 there is one nameless region.
  RawMesh mesh(MeshReport& report) const;
};

}  // namespace plica
