// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/meshes/files/deck_gather.hpp>
#include <span>

/// Elements of Abaqus and CalculiX (their manuals, "Element library").
namespace plica {

/// Families of elements; letters may follow the name, as in C3D10MH
inline constexpr NamedKind inp_kinds[] = {
    {"C3D4", {0, "tetrahedron", 3, 4, 4}},
    {"DC3D4", {0, "tetrahedron", 3, 4, 4}},
    {"C3D10", {0, "second-order tetrahedron", 3, 10, 4}},
    {"DC3D10", {0, "second-order tetrahedron", 3, 10, 4}},
    {"C3D5", {0, "pyramid", 3, 5, 5}},
    {"C3D6", {0, "prism", 3, 6, 6}},
    {"SC6", {0, "prism", 3, 6, 6}},
    {"C3D15", {0, "second-order prism", 3, 15, 6}},
    {"C3D8", {0, "hexahedron", 3, 8, 8}},
    {"SC8", {0, "hexahedron", 3, 8, 8}},
    {"C3D20", {0, "second-order hexahedron", 3, 20, 8}},
    {"S3", {0, "triangle", 2, 3, 3}},
    {"STRI3", {0, "triangle", 2, 3, 3}},
    {"M3D3", {0, "triangle", 2, 3, 3}},
    {"SFM3D3", {0, "triangle", 2, 3, 3}},
    {"R3D3", {0, "triangle", 2, 3, 3}},
    {"CPS3", {0, "triangle", 2, 3, 3}},
    {"CPE3", {0, "triangle", 2, 3, 3}},
    {"S6", {0, "second-order triangle", 2, 6, 3}},
    {"STRI65", {0, "second-order triangle", 2, 6, 3}},
    {"M3D6", {0, "second-order triangle", 2, 6, 3}},
    {"SFM3D6", {0, "second-order triangle", 2, 6, 3}},
    {"CPS6", {0, "second-order triangle", 2, 6, 3}},
    {"CPE6", {0, "second-order triangle", 2, 6, 3}},
    {"S4", {0, "quadrangle", 2, 4, 4}},
    {"M3D4", {0, "quadrangle", 2, 4, 4}},
    {"SFM3D4", {0, "quadrangle", 2, 4, 4}},
    {"R3D4", {0, "quadrangle", 2, 4, 4}},
    {"S8", {0, "second-order quadrangle", 2, 8, 4}},
    {"T3D2", {0, "line", 1, 2, 2}},
    {"B31", {0, "line", 1, 2, 2}},
    {"T3D3", {0, "second-order line", 1, 3, 2}},
    {"B32", {0, "second-order line", 1, 3, 2}},
    {"MASS", {0, "point", 0, 1, 1}},
    {"SPRINGA", {0, "line", 1, 2, 2}},
};

/// Corners of a face S1, S2, ... of a cell; a triangle has -1 at the end.
using FaceCorners = std::array<int, 4>;
inline constexpr FaceCorners
    tet_faces[] = {{0, 1, 2, -1}, {0, 3, 1, -1}, {1, 3, 2, -1}, {2, 3, 0, -1}},
    pyramid_faces[] = {{0, 1, 2, 3}, {0, 4, 1, -1}, {1, 4, 2, -1}, {2, 4, 3, -1}, {3, 4, 0, -1}},
    prism_faces[] = {{0, 1, 2, -1}, {3, 5, 4, -1}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}},
    hexahedron_faces[] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                          {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};

/// Returns the faces of a kind of cell, S1 first.
inline std::span<const FaceCorners> inp_faces(const ElementKind& kind) {
  if (kind.corners == 4) return tet_faces;
  if (kind.corners == 5) return pyramid_faces;
  if (kind.corners == 6) return prism_faces;
  return hexahedron_faces;
}

}  // namespace plica
