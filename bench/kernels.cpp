// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/elasticity.hpp>
#include <plica/drivers/solver/set_up/build_level.hpp>
#include <plica/kernels/elastic/gather_forces.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/implicit/system_kernels.hpp>
#include <plica/kernels/materials/list.hpp>

#include "beam.hpp"
#include "case.hpp"
#include "counted.hpp"
#include "fixture.hpp"
#include "measure.hpp"
#include "suites.hpp"

namespace plica::bench {

namespace {

/// A beam in a bent state.
template <class B>
struct BentBeam {
  typename B::Exec exec;
  Level<B> level;
  Vectors<B> direction;
  std::unique_ptr<Elasticity<B>> elasticity;

  BentBeam(const Cells& cells, const std::string& material) : elasticity(make_elasticity<B>(material)) {
    const Problem problem = beam_problem({cells}, material);
    const TetMesh& mesh = problem.body.levels.front();
    level = build_level<B>(problem.body, mesh, level_constants(problem.body, mesh, Point::Zero(), 0));
    level.state.u = direction = to_field<B>(bent(mesh, 0.1 / cells[0]));
  }
};

/// Compulsory bytes: per tetrahedron its corners and shape, per vertex `numbers` of the precision.
template <class B>
double compulsory_bytes(const Model<B>& model, int numbers) {
  constexpr double s = sizeof(typename B::Real);
  return model.tets * (4 * sizeof(std::uint16_t) + 10 * s) + model.vertices * (numbers * s);
}

template <class B>
void force(benchmark::State& state, const Case& c, double flops) {
  auto& beam =
      fixture<BentBeam<B>>("bent " + c.name, [&] { return std::make_shared<BentBeam<B>>(c.cells, c.material); });
  const Model<B>& model = beam.level.model;
  const double tets = model.tets;
  measure<typename B::Real>(state, beam.exec, {tets, compulsory_bytes(model, 3 + 3 + 1), tets * flops}, [&] {
    beam.elasticity->force(beam.exec, beam.level, beam.level.state, 1);
    gather_forces<B>(beam.exec, model, beam.level.partial, {}, beam.level.f);
  });
}

template <class B>
void tangent(benchmark::State& state, const Case& c, double flops) {
  using Real = typename B::Real;
  auto& beam =
      fixture<BentBeam<B>>("bent " + c.name, [&] { return std::make_shared<BentBeam<B>>(c.cells, c.material); });
  const Model<B>& model = beam.level.model;
  const double tets = model.tets;
  measure<Real>(state, beam.exec, {tets, compulsory_bytes(model, 3 + 3 + 3 + 1), tets * flops}, [&] {
    beam.elasticity->tangent(beam.exec, beam.level, beam.level.state.u, beam.direction, 0);
    update_vertices<B>(beam.exec, "bench::product", model.vertices,
                       SystemProduct<B>{model, beam.direction, beam.level.partial, beam.level.f, Real(1), Real(1)});
  });
}

}  // namespace

void register_kernels() {
  for_each_case<Materials>([]<class B, class Material>(const Case& c) {
    benchmark::RegisterBenchmark(("force/" + c.name).c_str(), force<B>, c, flops_per_tet<Material>(1));
    benchmark::RegisterBenchmark(("tangent/" + c.name).c_str(), tangent<B>, c, flops_per_tet<Material>(2));
  });
}

}  // namespace plica::bench
