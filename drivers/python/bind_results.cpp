// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <plica/core/reports.hpp>
#include <plica/drivers/python/bind_results.hpp>
#include <string>
#include <tuple>

namespace nb = nanobind;

namespace plica::python {

void bind_results(nb::module_& m) {
  nb::class_<Diagnosis>(
      m, "Diagnosis",
      "Why a run cannot go on. Indices count as the mesh's file does; -1: does not apply.")
      .def_ro("kind", &Diagnosis::kind,
              "non_finite, inverted, energy, speed, contact, solver, stability or cut")
      .def_ro("level", &Diagnosis::level, "0: the finest")
      .def_ro("element", &Diagnosis::element, "tetrahedron of that level")
      .def_ro("vertex", &Diagnosis::vertex, "vertex of that level")
      .def_ro("region", &Diagnosis::region, "of the element")
      .def_ro("J", &Diagnosis::J, "volume ratio of the element")
      .def_ro("substep_over_critical", &Diagnosis::substep_over_critical, "of that level")
      .def_ro("remedy", &Diagnosis::remedy, "most likely to help")
      .def("__str__", &Diagnosis::text)
      .def("__repr__", [](const Diagnosis& d) { return "<plica.Diagnosis: " + d.text() + ">"; })
      .def("__getstate__",
           [](const Diagnosis& d) {
             return std::make_tuple(d.kind, d.level, d.element, d.vertex, d.region, d.J,
                                    d.substep_over_critical, d.motion_over_edge, d.reason,
                                    d.remedy);
           })
      .def("__setstate__",
           [](Diagnosis& d, const std::tuple<std::string, int, int, int, std::string, double,
                                             double, double, std::string, std::string>& state) {
             std::apply([&](const auto&... part) { new (&d) Diagnosis{part...}; }, state);
           });
  nb::class_<Energies>(m, "Energies", "Energies of level 0 [J].")
      .def_ro("kinetic", &Energies::kinetic, "of motion [J]")
      .def_ro("elastic", &Energies::elastic, "of deformation [J]")
      .def_ro("potential", &Energies::potential, "gravity's, zero at the start [J]")
      .def_ro("contact", &Energies::contact, "of the penalties [J]")
      .def_prop_ro("total", &Energies::total, "their sum [J]")
      .def("__repr__",
           [](const Energies& e) {
             return "Energies(kinetic=" + std::to_string(e.kinetic) +
                    ", elastic=" + std::to_string(e.elastic) +
                    ", potential=" + std::to_string(e.potential) +
                    ", contact=" + std::to_string(e.contact) + ")";
           })
      .def("__getstate__",
           [](const Energies& e) {
             return std::make_tuple(e.kinetic, e.elastic, e.potential, e.contact);
           })
      .def("__setstate__",
           [](Energies& e, const std::tuple<double, double, double, double>& state) {
             std::apply([&](const auto&... part) { new (&e) Energies{part...}; }, state);
           });
}

}  // namespace plica::python
