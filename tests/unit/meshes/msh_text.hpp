// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "mesh_input.hpp"

namespace plica::test {

/// Two tetrahedra on a common face, a region each, and a set of the three lower nodes. Line 13 is node 1, 22 element 7.
inline const std::string two_tets =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n2 4 \"base\"\n3 1 \"tissue\"\n3 2 \"large tumour\"\n$EndPhysicalNames\n"
    "\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n10 0 0 1\n11 1 1 1\n$EndNodes\n"
    "$Elements\n3\n6 2 2 4 1 1 2 3\n7 4 2 1 1 1 2 3 10\n8 4 2 2 2 2 3 10 11\n$EndElements\n";

/// The same in MSH 4.1. Line 11 is the counts of entities, 17 those of nodes, 30 those of elements.
inline const std::string two_tets_4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n2 4 \"base\"\n3 1 \"tissue\"\n3 2 \"large tumour\"\n$EndPhysicalNames\n"
    "$Entities\n0 0 1 2\n3 0 0 0 1 1 0 1 4 0\n1 0 0 0 1 1 1 1 1 1 -3\n2 0 0 0 1 1 1 1 2 0\n$EndEntities\n"
    "$Nodes\n2 5 1 11\n2 3 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n3 1 0 2\n10\n11\n0 0 1\n1 1 1\n$EndNodes\n"
    "$Elements\n3 3 6 8\n2 3 2 1\n6 1 2 3\n3 1 4 1\n7 1 2 3 10\n3 2 4 1\n8 2 3 10 11\n$EndElements\n";

inline TetMesh read_text(const std::string& content, MeshReport* report = nullptr) {
  return read_mesh(MemoryFile{"m.msh", content}, report);
}

/// Reading fails at `line` (0: the message has none), and the message has every one of `parts`.
inline void expect_refused(const std::string& content, int line, const std::vector<std::string>& parts) {
  expect_refused(MemoryFile{"m.msh", content}, "m.msh" + (line > 0 ? ":" + std::to_string(line) : ""), parts);
}

}  // namespace plica::test
