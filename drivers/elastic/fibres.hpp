// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/nodal_rows.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <string>
#include <vector>

namespace plica {

/// Returns for each tetrahedron of level 0 the direction of heat flow between two sets of vertices.
/// It is the gradient of the temperature, 0 at `from` and 1 at `to`, in a body of uniform
/// conductivity that loses no heat. An element where the gradient is 0, in a corner that lies in
/// one set or in a dead end, gets the direction of the elements beside it. `path`: name of the
/// option for messages. Throws InputError where a set is empty, where a vertex is in both, and
/// where a part of the body touches only one set.
std::vector<Point> flow_directions(const TetMesh& mesh, const Selection& from, const Selection& to,
                                   const std::string& path);

/// Directions of fibres and of their sheet: unit vectors, orthogonal to each other.
using FibreAxes = std::array<Point, 2>;

/// Returns the directions that options give at a point of the body at rest, without fields.
FibreAxes fibre_axes(const FibreOptions& options, const Point& at);

/// Returns the directions of each tetrahedron of a level, whose mesh has its regions.
/// Where the level's mesh does not have a field, the nearest tetrahedron of level 0 gives the
/// direction. Empty for a body without fibres. Throws InputError for a field that level 0 does not
/// have, and for a vector of length 0.
std::vector<FibreAxes> element_fibres(const Body& body, const TetMesh& mesh, int level);

/// Replaces fibres that run between two sets of vertices by a field of every level's mesh.
/// `field`: its name. The sets are then not needed any more.
void flows_to_fields(Body& body, const std::string& field);

/// Gives every level's mesh the fields of vectors that only level 0 has: those of the nearest
/// tetrahedra. A level can then be used without level 0.
void fields_to_levels(Body& body);

/// Returns the two directions that a law's kernels take, by their components along fibre, sheet and
/// the normal of both: [1, 0, 0] and [0, 1, 0], unless the law has families at an angle to the
/// fibre.
/// @param values  parameter_values() of a law with fibres
FibreAxes family_components(const MaterialInfo& law, std::vector<double> values);

/// Returns true where a body, or a region of it, has fibres.
bool has_fibres(const Body& body);

/// Returns true where the directions differ between elements: by a rule or a field.
bool fibres_vary(const Body& body);

/// Copies the directions to the device, one pair for each element of the patches.
/// @param of_tets   directions of fibres and sheet per tetrahedron
/// @param families  per region: the two directions that the law takes, see family_components()
template <class B>
Scalars<B> device_fibres(const Patches<B>& patches, const TetMesh& mesh,
                         const std::vector<FibreAxes>& of_tets,
                         const std::vector<FibreAxes>& families);
/// Copies directions to the device, one pair for each domain: that nearest to its elements' fibres.
template <class B>
Scalars<B> device_fibres(const NodalRows<B>& rows, const TetMesh& mesh,
                         const std::vector<FibreAxes>& of_tets,
                         const std::vector<FibreAxes>& families);

}  // namespace plica
