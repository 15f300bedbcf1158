// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/study/verify/context.hpp>

namespace plica {

using VerifyRows = std::vector<VerifyRow>;

VerifyRows affine_patch(const VerifyContext&);
VerifyRows rigid_motion(const VerifyContext&);
VerifyRows derivatives(const VerifyContext&);
VerifyRows hanging_bar(const VerifyContext&);
VerifyRows uniaxial_tension(const VerifyContext&);

/// A problem with a known answer.
struct VerifyProblem {
  const char* name;
  const char* summary;
  VerifyRows (*rows)(const VerifyContext&);
};

/// All there are. One more: its file in this folder, its function above, its line here.
inline constexpr VerifyProblem verify_list[] = {
    {"affine_patch", "an irregular mesh takes an affine deformation exactly, in every material", affine_patch},
    {"rigid_motion", "a turned and moved body feels no force; small-strain `linear` feels a known one", rigid_motion},
    {"derivatives", "energy, force and tangent are each other's derivatives, in every material", derivatives},
    {"hanging_bar", "a bar under its own weight", hanging_bar},
    {"uniaxial_tension", "a bar under traction at both ends", uniaxial_tension}};

}  // namespace plica
