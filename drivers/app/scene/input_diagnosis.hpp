// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/run/simulation.hpp>

namespace plica::app {

/// Returns the diagnosis with the numbers that element and vertex have in the mesh file.
inline Diagnosis in_input_numbers(Diagnosis diagnosis, const Scene& scene) {
  const Numbering& numbering =
      scene.numbering[static_cast<std::size_t>(std::max(diagnosis.level, 0))];
  diagnosis.element = input_number(numbering.tet_ids, diagnosis.element);
  diagnosis.vertex = input_number(numbering.vertex_ids, diagnosis.vertex);
  return diagnosis;
}

}  // namespace plica::app
