// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/files/parsed_mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// Returns the rank of an array's name among the usual names of regions, such as "region",
/// "gmsh:physical" or "MaterialIds", in any case of letters; -1: it is none of them.
int rank_as_regions(const std::string& array);

/// Makes regions from one of raw.numbers, in ascending order; numbers with one name are one region.
/// Where all numbers are 0 there is one nameless region. Without a wanted name these are the
/// format's own numbers, else the array with the most usual name. Notes which array was taken where
/// there are several, and those that are not used.
/// @param wanted  name of the array, "none", or empty
/// @throw InputError for an unknown name, numbers that are no integers, and a region for every cell
void choose_regions(ParsedMesh& raw, const std::string& wanted, MeshReport& report);

/// Drops the tetrahedra of some regions, by name or number, and counts them in the report.
/// @throw InputError for an unknown region, or if no tetrahedron is left
void leave_out_regions(ParsedMesh& raw, const std::vector<std::string>& regions,
                       MeshReport& report);

}  // namespace plica
