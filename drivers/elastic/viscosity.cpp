// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/to_device.hpp>
#include <plica/drivers/elastic/viscosity.hpp>
#include <plica/kernels/elastic/relaxed_stress.hpp>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

namespace {

/// Kernel that scales the energy of shape: constants = whole + 2 share (half - whole).
template <class B>
struct ScaleShape {
  Scalars<B> whole, half, to, share;
  Indices<B> set_region;
  int of_set;  ///< number of constants in a set
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    to(i) = whole(i) + 2 * share(set_region(i / of_set)) * (half(i) - whole(i));
  }
};

/// Returns the region of each set of the level's constants.
template <class B>
std::vector<int> regions_of_sets(const TetMesh& mesh, const LevelData<B>& level) {
  std::vector<int> regions;
  if (level.model.rows.slices > 0) {
    const std::size_t count = mesh.region.empty() ? 1 : mesh.region_names.size();
    for (std::size_t r = 0; r < count; ++r) regions.push_back(static_cast<int>(r));
    return regions;
  }
  const auto first = on_host(level.model.patches.first_pack),
             element = on_host(level.model.patches.element);
  for (int p = 0; p < level.model.patches.count; ++p) {
    const auto tet = static_cast<std::size_t>(element(first(p) * B::lanes));
    regions.push_back(mesh.region.empty() ? 0 : mesh.region[tet]);
  }
  return regions;
}

template <class B>
Scalars<B> constants_of_sets(const char* name, const std::vector<int>& regions,
                             const std::vector<std::vector<double>>& of_regions) {
  std::vector<typename B::Real> all;
  for (const int r : regions)
    for (const double value : of_regions[static_cast<std::size_t>(r)])
      all.push_back(static_cast<typename B::Real>(value));
  return to_device<Scalars<B>>(name, all);
}

/// Returns the region of each pack of elements or rows.
template <class B>
std::vector<int> regions_of_packs(const TetMesh& mesh, const LevelData<B>& level) {
  std::vector<int> regions;
  const NodalRows<B>& rows = level.model.rows;
  if (rows.slices > 0) {
    const auto region = on_host(rows.region);
    for (int slot = 0; slot < rows.slots(); slot += B::lanes)
      regions.push_back(region(slot / NodalRows<B>::height));
    return regions;
  }
  const auto first = on_host(level.model.patches.first_pack);
  const std::vector<int> of_patch = regions_of_sets(mesh, level);
  for (std::size_t p = 0; p < of_patch.size(); ++p)
    regions.resize(static_cast<std::size_t>(first(p + 1)), of_patch[p]);
  return regions;
}

template <class B>
RelaxationSteps<B> relaxation_steps(const std::vector<std::vector<PronyTerm>>& prony) {
  RelaxationSteps<B> steps;
  for (const auto& series : prony)
    steps.terms = std::max(steps.terms, static_cast<int>(series.size()));
  std::vector<double> alpha, tau;
  for (std::vector<PronyTerm> series : prony) {
    series.resize(static_cast<std::size_t>(steps.terms), {0, 1});
    for (const PronyTerm& term : series) alpha.push_back(term.alpha), tau.push_back(term.tau);
  }
  steps.alpha = to_device<Doubles<B>>("viscosity.alpha", alpha),
  steps.tau = to_device<Doubles<B>>("viscosity.tau", tau);
  steps.step = Scalars<B>("plica::viscosity.step", 2 * alpha.size());
  steps.weight = Scalars<B>("plica::viscosity.weight", alpha.size() + prony.size());
  steps.share = Scalars<B>("plica::viscosity.share", prony.size());
  return steps;
}

}  // namespace

template <class B>
Viscosity<B>::Viscosity(const ShapeConstants& constants, const std::string& rule,
                        const TetMesh& mesh, LevelData<B>& level)
    : steps_(relaxation_steps<B>(constants.prony)) {
  steps_.backward_euler = rule == "backward_euler";
  const bool nodal = level.model.rows.slices > 0;
  const std::vector<int> regions = regions_of_sets(mesh, level);
  forces_ = sets_of(nodal ? level.model.rows.constants : level.model.patches.constants, regions,
                    constants);
  if (!nodal && level.ranks)
    matrix_ = sets_of(level.ranks->around_owned.constants, level.ranks->region_around, constants);
  isochoric_ = constants_of_sets<B>("viscosity.isochoric", regions, constants.isochoric);
  const auto slots = static_cast<std::size_t>(nodal ? level.model.rows.slots()
                                                    : level.model.patches.packs * B::lanes);
  ViscousHistory<B>& stress = level.stress;
  stress.terms = steps_.terms, stress.step = steps_.step;
  stress.region = to_device<Indices<B>>("viscosity.region", regions_of_packs(mesh, level));
  stress.memory = zeros<Scalars<B>>("plica::viscosity.memory",
                                    slots * 6 * static_cast<std::size_t>(1 + stress.terms));
  stress.relaxed = zeros<Scalars<B>>("plica::viscosity.lost", slots * 6);
  stepped_ = none;
}

template <class B>
auto Viscosity<B>::sets_of(const Scalars<B>& constants, const std::vector<int>& regions,
                           const ShapeConstants& shape) -> Sets {
  return {constants, to_device<Indices<B>>("viscosity.set_region", regions),
          to_device<Scalars<B>>("viscosity.whole", host_values(Exec(), constants)),
          constants_of_sets<B>("viscosity.half", regions, shape.half)};
}

/// Computes the values of steps_ for a time t [s] after that of the memory.
template <class B>
void Viscosity<B>::step_over(const Exec& exec, double t) {
  if (t == stepped_) return;
  stepped_ = t;
  RelaxationSteps<B> steps = steps_;
  steps.t = t;
  update_vertices<B>(exec, "plica::relaxation_steps", static_cast<int>(steps.share.extent(0)),
                     steps);
}

template <class B>
void Viscosity<B>::accept_state(const Exec& exec, const LevelData<B>& level,
                                const Elasticity<B>& elasticity, const Vectors<B>& u, double time) {
  step_over(exec, std::max(0.0, time - time_));
  elasticity.accept_state(exec, level, u, isochoric_);
  time_ = time, looked_ = none;
}

template <class B>
void Viscosity<B>::prepare_at(const Exec& exec, const LevelData<B>& level, double time) {
  const double t = std::max(0.0, time - time_);
  take_share(exec, t);
  if (t == looked_) return;
  step_over(exec, t);
  update_vertices<B>(exec, "plica::combine_memory",
                     static_cast<int>(level.stress.relaxed.extent(0)),
                     CombineHistory<B>{level.stress, steps_.weight});
  looked_ = t;
}

/// Sets the model's constants for a time t [s] after that of the memory.
/// Their energy of shape is without the part that relaxes over that time.
template <class B>
void Viscosity<B>::take_share(const Exec& exec, double t) {
  if (t == shared_) return;
  step_over(exec, t), shared_ = t;
  scale(exec, forces_), scale(exec, matrix_);
}

template <class B>
void Viscosity<B>::scale(const Exec& exec, const Sets& of) const {
  const auto sets = static_cast<int>(of.region.extent(0)),
             count = static_cast<int>(of.constants.extent(0));
  if (sets == 0) return;  // one of several ranks may have no element
  update_vertices<B>(
      exec, "plica::scale_shape", count,
      ScaleShape<B>{of.whole, of.half, of.constants, steps_.share, of.region, count / sets});
}

template <class B>
void Viscosity<B>::name_fields(Archive<B>& archive, const LevelData<B>& level,
                               const std::string& name) {
  archive.field(name + "memory of stress", level.stress.memory, RowItems::elements);
  archive.number(time_);
  for (const Sets* sets : {&forces_, &matrix_})
    archive.owns(sets->constants, sets->region, sets->whole, sets->half);
  archive.owns(level.stress, steps_, isochoric_);
  if (archive.restoring()) looked_ = none;
}

#define PLICA_INSTANTIATE(Real, Exec) template class Viscosity<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
