// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/kernels/materials/parameters.hpp>
#include <vector>

namespace plica {

/// How the strain of a level is worked out from its vertices.
enum class Element { linear, nodal };

/// That of a level: as body.element says.
Element element_of(const Body& body, std::size_t level);

/// "linear" or "nodal"
const char* name_of(Element element);

/// Poisson's ratio of small strains.
double poisson_ratio(const Lame<double>& lame);

/// Whether the pressures of nodal elements are smoothed: as body.pressure says, `auto` where a
/// region has nu above 0.49 and the material a stiffness for the volume alone.
bool smooths_pressure(const Body& body, const std::vector<Lame<double>>& of_regions);

/// About how far a slender clamped beam bends with these elements, over what it should: 1 / (1 +
/// c/n^2) with n elements across. Fitted to measured beams of irregular tetrahedra, 2, 4 and 8
/// across, nu from 0.3 to 0.49, within 0.06.
double bending_ratio(Element element, double poisson_ratio, double across);

/// About how many elements lie across the body's thickness. The larger of 4 V/S of a beam, over the
/// cube root of six mean elements, and, for flat elements, what the part r of vertices inside a
/// beam's section says: (1 + sqrt r) / (1 - sqrt r).
double elements_across(const TetMesh& mesh);

/// The part of lambda that acts on each domain; the rest acts on smoothed volumes.
inline double capped_lambda(const Lame<double>& c) {
  return c.lambda < 2 * c.mu ? c.lambda : 2 * c.mu;
}

}  // namespace plica
