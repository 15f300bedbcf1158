// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/kernels/materials/parameters.hpp>
#include <vector>

namespace plica {

/// Kind of elements: how the strain of a level is computed from its vertices.
enum class Element { linear, nodal };

/// Returns the kind of elements of a level, as body.element says.
Element element_of(const Body& body, std::size_t level);

/// Returns "linear" or "nodal".
const char* name_of(Element element);

/// Returns Poisson's ratio of small strains.
double poisson_ratio(const Lame<double>& lame);

/// Returns true where the pressures of nodal elements are smoothed, as body.pressure says.
/// `auto`: smoothed where a region has nu above 0.49 and the material has a stiffness of the volume
/// alone.
bool smooths_pressure(const Body& body, const std::vector<Lame<double>>& of_regions);

/// Returns about how far a slender clamped beam of these elements bends, over the exact bending.
/// The ratio is 1 / (1 + c/n^2) with n elements across. It was fitted to beams of irregular
/// tetrahedra, 2, 4 and 8 across, nu from 0.3 to 0.49, within 0.06.
double bending_ratio(Element element, double poisson_ratio, double across);

/// Returns about how many elements lie across the body's thickness: the larger of two estimates.
/// The first is 4 V/S, a beam's thickness, over the cube root of the volume of six mean elements.
/// The second, for flat elements, is (1 + sqrt r) / (1 - sqrt r), r the part of the vertices that
/// are inside.
double elements_across(const TetMesh& mesh);

/// Returns the part of the volume where a body is one element across: in tetrahedra of which every
/// vertex lies on a surface of its region. It is 1 for a strip of one cell across, at most 0.5 for
/// boxes of two, and a few hundredths for organs.
double part_one_across(const TetMesh& mesh);

/// Returns the part of lambda that acts on each domain [Pa]; the rest acts on smoothed volumes.
inline double capped_lambda(const Lame<double>& c) {
  return c.lambda < 2 * c.mu ? c.lambda : 2 * c.mu;
}

}  // namespace plica
