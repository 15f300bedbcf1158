// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/drivers/solver/viscosity.hpp>
#include <plica/kernels/elastic/lost_stress.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

namespace {

/// constants = whole + 2 share (half - whole)
template <class B>
struct ScaleShape {
  Scalars<B> whole, half, to;
  typename B::Real share;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const { to(i) = whole(i) + 2 * share * (half(i) - whole(i)); }
};

/// Of each set of the level's constants its region.
template <class B>
std::vector<int> regions_of_sets(const TetMesh& mesh, const Level<B>& level) {
  std::vector<int> regions;
  if (level.model.rows.slices > 0) {
    const std::size_t count = mesh.region.empty() ? 1 : mesh.region_names.size();
    for (std::size_t r = 0; r < count; ++r) regions.push_back(static_cast<int>(r));
    return regions;
  }
  const auto first = on_host(level.model.patches.first_pack), element = on_host(level.model.patches.element);
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

/// (1 - e^-x) / x
double mean_decay(double x) { return x > 0 ? -std::expm1(-x) / x : 1; }

}  // namespace

template <class B>
Viscosity<B>::Viscosity(const std::vector<PronyTerm>& terms, const ShapeConstants& constants, const TetMesh& mesh,
                        Level<B>& level)
    : terms_(terms) {
  const bool nodal = level.model.rows.slices > 0;
  const std::vector<int> regions = regions_of_sets(mesh, level);
  constants_ = nodal ? level.model.rows.constants : level.model.patches.constants;
  whole_ = Scalars<B>("plica::viscosity.whole", constants_.extent(0));
  Kokkos::deep_copy(whole_, constants_);
  half_ = constants_of_sets<B>("viscosity.half", regions, constants.half);
  isochoric_ = constants_of_sets<B>("viscosity.isochoric", regions, constants.isochoric);
  const auto slots = static_cast<std::size_t>(nodal ? level.model.rows.slots() : level.model.patches.packs * B::lanes);
  level.stress.terms = static_cast<int>(terms.size());
  level.stress.memory = zeros<Scalars<B>>("plica::viscosity.memory", slots * 6 * (1 + terms.size()));
  level.stress.lost = zeros<Scalars<B>>("plica::viscosity.lost", slots * 6);
}

template <class B>
RelaxationStep<typename B::Real> Viscosity<B>::step_over(double t) const {
  RelaxationStep<Real> step;
  for (const PronyTerm& term : terms_) {
    const double x = t / term.tau;
    step.keep[step.terms] = static_cast<Real>(std::exp(-x));
    step.gain[step.terms++] = static_cast<Real>(mean_decay(x));
  }
  return step;
}

template <class B>
void Viscosity<B>::remember(const Exec& exec, const Level<B>& level, const Elasticity<B>& elasticity,
                            const Vectors<B>& u, double time) {
  elasticity.remember(exec, level, u, isochoric_, step_over(std::max(0.0, time - time_)));
  time_ = time, looked_ = none;
}

template <class B>
void Viscosity<B>::look_at(const Exec& exec, const Level<B>& level, double time) {
  const double t = std::max(0.0, time - time_);
  double share = 0, elastic = 0;
  CombineMemory<B> combine{level.stress, 0, {}};
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const auto& [alpha, tau] = terms_[i];
    const double gain = mean_decay(t / tau);
    share += alpha * (1 - gain), elastic += alpha * gain;
    combine.term[i] = static_cast<Real>(alpha * std::exp(-t / tau));
  }
  set_share(exec, share);
  if (t == looked_) return;
  combine.elastic = static_cast<Real>(elastic);
  update_vertices<B>(exec, "plica::combine_memory", static_cast<int>(level.stress.lost.extent(0)), combine);
  looked_ = t;
}

template <class B>
void Viscosity<B>::set_share(const Exec& exec, double share) {
  if (share == share_) return;
  share_ = share;
  update_vertices<B>(exec, "plica::scale_shape", static_cast<int>(constants_.extent(0)),
                     ScaleShape<B>{whole_, half_, constants_, static_cast<Real>(share)});
}

template <class B>
void Viscosity<B>::keep(const Exec& exec, const Level<B>& level, Kept& to) const {
  if (to.memory.extent(0) == 0) to.memory = Scalars<B>("plica::viscosity.kept", level.stress.memory.extent(0));
  Kokkos::deep_copy(exec, to.memory, level.stress.memory);
  to.time = time_;
}

template <class B>
void Viscosity<B>::put_back(const Exec& exec, const Level<B>& level, const Kept& from) {
  Kokkos::deep_copy(exec, level.stress.memory, from.memory);
  set_time(from.time);
}

template <class B>
void Viscosity<B>::persist(StateArchive<B>& archive, const Level<B>& level, const std::string& name) {
  archive.field(name + "memory of stress", level.stress.memory);
  archive.number(time_);
  if (archive.restoring()) looked_ = none;
}

template <class B>
std::size_t Viscosity<B>::bytes(const Level<B>& level) const {
  const std::size_t numbers = level.stress.memory.extent(0) + level.stress.lost.extent(0) + whole_.extent(0) +
                              half_.extent(0) + isochoric_.extent(0);
  return numbers * sizeof(Real);
}

#define PLICA_INSTANTIATE(Real, Exec) template class Viscosity<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
