// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/files/raw_mesh.hpp>
#include <plica/meshes/files/reading.hpp>
#include <string>
#include <vector>

namespace plica {

/// Of VTK (its header vtkCellType.h).
inline constexpr ElementKind vtk_cells[] = {
    {1, "point", 0, 1, true},
    {2, "set of points", 0, 0, true},
    {3, "line", 1, 2, true},
    {4, "polyline", 1, 0, true},
    {5, "triangle", 2, 3, true},
    {6, "strip of triangles", 2, 0, true},
    {7, "polygon", 2, 0, true},
    {8, "pixel", 2, 4, true},
    {9, "quadrangle", 2, 4, true},
    {10, "tetrahedron", 3, 4, true},
    {11, "voxel", 3, 8, false},
    {12, "hexahedron", 3, 8, false},
    {13, "prism", 3, 6, false},
    {14, "pyramid", 3, 5, false},
    {15, "pentagonal prism", 3, 10, false},
    {16, "hexagonal prism", 3, 12, false},
    {21, "second-order line", 1, 3, false},
    {22, "second-order triangle", 2, 6, false},
    {23, "second-order quadrangle", 2, 8, false},
    {24, "second-order tetrahedron", 3, 10, false},
    {25, "second-order hexahedron", 3, 20, false},
    {26, "second-order prism", 3, 15, false},
    {27, "second-order pyramid", 3, 13, false},
    {42, "polyhedron", 3, 0, false},
    {71, "Lagrange tetrahedron", 3, 0, false},
    {78, "Bezier tetrahedron", 3, 0, false},
};

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
