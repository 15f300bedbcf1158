// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/element_kind.hpp>

namespace plica {

/// Of the MSH formats (Gmsh reference manual, "MSH file format").
inline constexpr ElementKind msh_elements[] = {
    {15, "point", 0, 1, true},
    {1, "line", 1, 2, true},
    {2, "triangle", 2, 3, true},
    {3, "quadrangle", 2, 4, true},
    {4, "tetrahedron", 3, 4, true},
    {5, "hexahedron", 3, 8, false},
    {6, "prism", 3, 6, false},
    {7, "pyramid", 3, 5, false},
    {8, "second-order line", 1, 3, false},
    {9, "second-order triangle", 2, 6, false},
    {10, "second-order quadrangle", 2, 9, false},
    {11, "second-order tetrahedron", 3, 10, false},
    {12, "second-order hexahedron", 3, 27, false},
    {13, "second-order prism", 3, 18, false},
    {14, "second-order pyramid", 3, 14, false},
    {16, "second-order quadrangle", 2, 8, false},
    {17, "second-order hexahedron", 3, 20, false},
    {18, "second-order prism", 3, 15, false},
    {19, "second-order pyramid", 3, 13, false},
    {20, "third-order triangle", 2, 9, false},
    {21, "third-order triangle", 2, 10, false},
    {26, "third-order line", 1, 4, false},
    {29, "third-order tetrahedron", 3, 20, false},
    {30, "fourth-order tetrahedron", 3, 35, false},
    {92, "third-order hexahedron", 3, 64, false},
};

}  // namespace plica
