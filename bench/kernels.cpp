// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/text.hpp>
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/drivers/level/build_level.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/kernels/elastic/gather_forces.hpp>
#include <plica/kernels/linear/system_kernels.hpp>
#include <plica/kernels/materials/list.hpp>
#include <plica/kernels/time/updates.hpp>

#include "beam.hpp"
#include "case.hpp"
#include "compulsory.hpp"
#include "counted.hpp"
#include "measure.hpp"
#include "suites.hpp"

namespace plica::bench {

namespace {

/// A beam in a bent state.
template <class B>
struct BentBeam {
  typename B::Exec exec;
  LevelData<B> level;
  Vectors<B> direction;
  std::unique_ptr<Elasticity<B>> elasticity;

  BentBeam(const Cells& cells, const std::string& material, Element element)
      : elasticity(make_elasticity<B>(material, element)) {
    const Problem problem = beam_problem({cells}, material, name_of(element));
    const TetMesh& mesh = problem.body.levels.front();
    level =
        build_level<B>(problem.body, mesh, level_constants(problem.body, mesh, Point::Zero(), 0));
    level.state.u = direction = to_field<B>(bent(mesh, 0.1 / cells[0]));
  }
};

template <class B>
BentBeam<B>& bent_beam(const Case& c, Element element) {
  return fixture<BentBeam<B>>(text("bent ", name_of(element), " ", c.name), [&] {
    return std::make_shared<BentBeam<B>>(c.cells, c.material, element);
  });
}

template <class B>
void force(benchmark::State& state, const Case& c, double flops, Element element) {
  auto& beam = bent_beam<B>(c, element);
  const Model<B>& model = beam.level.model;
  const double tets = model.tets;
  measure<typename B::Real>(
      state, beam.exec, {tets, compulsory_bytes(model, 3 + 3 + 1), tets * flops}, [&] {
        beam.elasticity->force(beam.exec, beam.level, beam.level.state, 1);
        gather_forces<B>(beam.exec, model, beam.level.partial, {}, beam.level.f);
      });
}

template <class B>
void tangent(benchmark::State& state, const Case& c, double flops, Element element) {
  using Real = typename B::Real;
  auto& beam = bent_beam<B>(c, element);
  const Model<B>& model = beam.level.model;
  const double tets = model.tets;
  measure<Real>(
      state, beam.exec, {tets, compulsory_bytes(model, 3 + 3 + 3 + 1), tets * flops}, [&] {
        beam.elasticity->tangent(beam.exec, beam.level, beam.level.state.u, beam.direction, 0);
        update_vertices<B>(beam.exec, "bench::product", model.vertices,
                           SystemProduct<B>{model, beam.direction, beam.level.partial, beam.level.f,
                                            Real(1), Real(1)});
      });
}

}  // namespace

void register_kernels() {
  for_each_case<Materials>([]<class B, class Material>(const Case& c) {
    for (const Element element : {Element::linear, Element::nodal}) {
      const std::string prefix = element == Element::linear ? "" : "nodal_";
      // rows are judged by their bytes alone
      const double by_tets = element == Element::linear ? 1 : 0;
      benchmark::RegisterBenchmark((prefix + "force/" + c.name).c_str(), force<B>, c,
                                   by_tets * flops_per_tet<Material>(1), element);
      benchmark::RegisterBenchmark((prefix + "tangent/" + c.name).c_str(), tangent<B>, c,
                                   by_tets * flops_per_tet<Material>(2), element);
    }
  });
}

}  // namespace plica::bench
