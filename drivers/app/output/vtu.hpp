// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Triangles or tetrahedra with values at their vertices and on themselves.
struct VtuGrid {
  struct PointField {
    std::string name;
    std::vector<Point> values;
  };
  struct ScalarField {
    std::string name;
    std::vector<double> values;
  };
  struct CellField {
    std::string name;
    std::vector<int> values;
  };
  std::vector<Point> points;      ///< [m]
  std::vector<int> connectivity;  ///< the cells' vertices, one cell after the other
  int vertices_per_cell = 3;      ///< 3: triangles, 4: tetrahedra
  std::vector<PointField> point_fields;
  std::vector<ScalarField> point_scalars;
  std::vector<CellField> cell_fields;
  std::vector<ScalarField> cell_scalars;
  double time = 0;  ///< [s]
};

/// The grid as VTK's XML file (.vtu), its numbers appended in raw binary, double precision.
/// Source: the VTK file formats, https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
std::string vtu_text(const VtuGrid& grid);

}  // namespace plica::app
