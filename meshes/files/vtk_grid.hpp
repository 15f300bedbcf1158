// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/files/parsed_mesh.hpp>
#include <plica/meshes/files/reading.hpp>
#include <string>
#include <vector>

namespace plica {

/// Kinds of cells of VTK (VTK's header vtkCellType.h).
inline constexpr ElementKind vtk_cells[] = {
    {1, "point", 0, 1, 1},
    {2, "set of points", 0, 0, 0},
    {3, "line", 1, 2, 2},
    {4, "polyline", 1, 0, 0},
    {5, "triangle", 2, 3, 3},
    {6, "strip of triangles", 2, 0, 0},
    {7, "polygon", 2, 0, 0},
    {8, "pixel", 2, 4, 4},
    {9, "quadrangle", 2, 4, 4},
    {10, "tetrahedron", 3, 4, 4},
    {11, "voxel", 3, 8, 8},
    {12, "hexahedron", 3, 8, 8},
    {13, "prism", 3, 6, 6},
    {14, "pyramid", 3, 5, 5},
    {15, "pentagonal prism", 3, 10, not_taken},
    {16, "hexagonal prism", 3, 12, not_taken},
    {21, "second-order line", 1, 3, 2},
    {22, "second-order triangle", 2, 6, 3},
    {23, "second-order quadrangle", 2, 8, 4},
    {24, "second-order tetrahedron", 3, 10, 4},
    {25, "second-order hexahedron", 3, 20, 8},
    {26, "second-order prism", 3, 15, 6},
    {27, "second-order pyramid", 3, 13, 5},
    {28, "second-order quadrangle", 2, 9, 4},
    {29, "second-order hexahedron", 3, 27, 8},
    {32, "second-order prism", 3, 18, 6},
    {42, "polyhedron", 3, 0, not_taken},
    {68, "Lagrange line", 1, 0, 2},
    {69, "Lagrange triangle", 2, 0, 3},
    {70, "Lagrange quadrangle", 2, 0, 4},
    {71, "Lagrange tetrahedron", 3, 0, 4},
    {72, "Lagrange hexahedron", 3, 0, 8},
    {73, "Lagrange prism", 3, 0, 6},
    {74, "Lagrange pyramid", 3, 0, 5},
    {76, "Bezier triangle", 2, 0, 3},
    {77, "Bezier quadrangle", 2, 0, 4},
    {78, "Bezier tetrahedron", 3, 0, 4},
    {79, "Bezier hexahedron", 3, 0, 8},
    {80, "Bezier prism", 3, 0, 6},
};

/// Integer of a file and its place.
struct PlacedInteger {
  std::int64_t value = 0;
  Place place;
};
/// Reads `count` integers with their places.
std::vector<PlacedInteger> read_integers(std::int64_t count, NumberType type, std::string_view what,
                                         Numbers& numbers);

/// Unstructured grid, or the cells of polygonal data, of both VTK formats. Points and cells count
/// from 0.
struct VtkGrid {
  std::string file;
  std::vector<RawVertex> points;
  std::vector<PlacedInteger> connectivity;  ///< points of the cells, cell after cell
  std::vector<PlacedInteger> ends;          ///< per cell its end in `connectivity`
  std::vector<PlacedInteger> types;         ///< per cell the type in vtk_cells
  std::vector<RawNumbers> arrays;           ///< arrays with one number per cell
  std::vector<RawVectors> vectors;          ///< named vectors of cells and points

  /// Reads the coordinates of `count` points.
  void read_points(std::int64_t count, NumberType type, Numbers& numbers);
  /// Reads an array of the cells, or skips it. Arrays with one number per cell may give the
  /// regions, see choose_regions(). Arrays with three real numbers per cell are vectors.
  void read_cell_data(const std::string& name, std::int64_t tuples, std::int64_t components,
                      NumberType type, Numbers& numbers);
  /// Reads an array of the points, or skips it. Arrays with three real numbers per point are
  /// vectors.
  void read_point_data(const std::string& name, std::int64_t tuples, std::int64_t components,
                       NumberType type, Numbers& numbers);
  /// Adds cells of one kind.
  /// @param cell_ends  per cell its end in `points_of_cells`
  void add_cells(int type, const std::vector<PlacedInteger>& points_of_cells,
                 const std::vector<PlacedInteger>& cell_ends);
  /// Checks that the arrays fit each other, and returns the mesh. Cells become tetrahedra and
  /// faces; points and lines are counted and checked. Region 3 of the array "region" is named
  /// "region_3".
  ParsedMesh mesh(MeshReport& report) const;

 private:
  void read_vectors(const std::string& name, std::int64_t tuples, NumberType type, bool of_points,
                    Numbers& numbers);
  void add_strip(std::int64_t tag, std::span<const std::int64_t> corners, const Place& place,
                 ParsedMesh& raw, MeshReport& report) const;
};

}  // namespace plica
