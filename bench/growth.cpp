// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/text.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>

#include "beam.hpp"
#include "case.hpp"
#include "compulsory.hpp"
#include "measure.hpp"
#include "suites.hpp"

namespace plica::bench {

namespace {

using Double = Backend<double, Kokkos::DefaultExecutionSpace>;

/// Beams from 960 to 10 036 224 tetrahedra.
constexpr Cells growing_beams[] = {{4, 4, 10},    {6, 6, 15},    {9, 9, 22},
                                   {13, 13, 31},  {19, 19, 47},  {28, 28, 70},
                                   {41, 41, 101}, {59, 59, 147}, {88, 88, 216}};

/// A beam that begins to sag.
struct SaggingBeam {
  BuiltHierarchy<Double> built;
  double time = 0;

  SaggingBeam(const Cells& cells, const std::string& element)
      : built(build_hierarchy<Double>(beam_problem({cells}, "neo_hookean", element), {})) {}
  void step() {
    built.hierarchy->begin_macro_step(1);
    built.stepper->step(*built.hierarchy, time, built.macro_step);
    time += built.macro_step;
  }
};

/// One explicit step at 0.9 of the limit. Compulsory: elements, mass and its inverse, displacement
/// and velocity in and out. It is judged by its bytes alone.
void growing_step(benchmark::State& state, const Cells& cells, const std::string& element) {
  constexpr double bytes_per_tet = 700;  // of the set-up
  if (!has_room_for(bytes_per_tet * beam_tets(cells)))
    return state.SkipWithError("not enough memory");
  auto& beam = fixture<SaggingBeam>(text("sagging ", element, " ", beam_tets(cells)),
                                    [&] { return std::make_shared<SaggingBeam>(cells, element); });
  const auto& level = (*beam.built.hierarchy)[0];
  measure<double>(state, level.exec(),
                  {static_cast<double>(level.model.tets), compulsory_bytes(level.model, 14), 0},
                  [&] { beam.step(); });
}

}  // namespace

void register_growth() {
  for (const Cells& cells : growing_beams)
    for (const std::string element : {"linear", "nodal"})
      benchmark::RegisterBenchmark(text("growth/", element, "/", beam_tets(cells)).c_str(),
                                   growing_step, cells, element);
}

}  // namespace plica::bench
