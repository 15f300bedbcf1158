// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nanobind/nanobind.h>

namespace plica::python {

/// Adds Diagnosis and Energies to the module.
void bind_results(nanobind::module_& m);

}  // namespace plica::python
