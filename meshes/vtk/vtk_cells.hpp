// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/element_kind.hpp>

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

}  // namespace plica
