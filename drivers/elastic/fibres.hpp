// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/nodal_rows.hpp>
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Of each tetrahedron of level 0 the direction in which heat would flow from `from`, kept at 0, to
/// `to`, kept at 1, through a body that leads it alike everywhere and loses none: the gradient of
/// its temperature. Where the gradient is nothing, in a corner that lies in one set or in a dead
/// end, that of the elements beside it. `path` is the option for messages. InputError where a set
/// is not there, where a vertex is in both, and where a part of the body touches only one of them.
std::vector<Point> flow_directions(const TetMesh& mesh, const Selection& from, const Selection& to,
                                   const std::string& path);

/// Fibres and their sheet: unit vectors, orthogonal to each other.
using FibreAxes = std::array<Point, 2>;

/// Of these options at a point of the body at rest, but for fields.
FibreAxes fibre_axes(const FibreOptions& options, const Point& at);

/// Of each tetrahedron of a level, whose regions are known; where they come from a field that the
/// level's mesh does not have, those of the nearest tetrahedron of level 0. Empty for a body
/// without fibres. InputError for a field that level 0 does not have, or one of length 0.
std::vector<FibreAxes> element_fibres(const Body& body, const TetMesh& mesh, int level);

/// Turns fibres from one set of vertices to another into this field of every level's mesh, which
/// does not need the sets any more.
void flows_to_fields(Body& body, const std::string& field);

/// Whether a body, or a region of it, has fibres.
bool has_fibres(const Body& body);

/// Whether elements have fibres of their own: by a rule or a field.
bool fibres_vary(const Body& body);

/// As kernels take them: per element, and per domain the direction that its elements' are nearest
/// to.
template <class B>
Scalars<B> device_fibres(const Patches<B>& patches, const std::vector<FibreAxes>& of_tets);
template <class B>
Scalars<B> device_fibres(const NodalRows<B>& rows, const TetMesh& mesh,
                         const std::vector<FibreAxes>& of_tets);

}  // namespace plica
