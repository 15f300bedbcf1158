// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/level/integrator.hpp>
#include <plica/drivers/level/level.hpp>
#include <plica/kernels/elastic/gather_forces.hpp>
#include <plica/kernels/elastic/kept_tangents.hpp>
#include <plica/kernels/elastic/nodal_rows.hpp>
#include <plica/kernels/elastic/relaxed_stress.hpp>
#include <plica/kernels/linear/vertex_blocks.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

template <class B>
Level<B>::Level(LevelData<B>&& data, StageTimer<B>& clock, int number)
    : LevelData<B>(std::move(data)), clock_(&clock), number_(number) {
  int most = 0;
  for (const FollowerLoad<B>& load : this->followers)
    if (load.volume.extent(0) > 0) most = std::max(most, load.count);
  if (most > 0) volumes_ = BlockSums<B>(most), rate_ = zeros<Doubles<B>>("plica::volume_rate", 1);
}
template <class B>
Level<B>::Level(Level&&) noexcept = default;
template <class B>
Level<B>::~Level() = default;

template <class B>
void Level<B>::set_forces(std::shared_ptr<const Elasticity<B>> elasticity, const Point& gravity,
                          std::shared_ptr<const Contact<B>> contact, bool implicit) {
  elasticity_ = std::move(elasticity), contact_ = std::move(contact), implicit_ = implicit;
  for (int k = 0; k < 3; ++k) gravity_[k] = static_cast<typename B::Real>(gravity[k]);
  if (contact_) response_ = ContactResponse<B>(contact_, *this, implicit);
  const NodalRows<B>& rows = this->model.rows;
  // not with smoothed pressures, which need both fields once more
  if (implicit && rows.slices > 0 && rows.bulk_excess.extent(0) == 0)
    this->nodal.gradient =
        zeros<Scalars<B>>("plica::nodal.gradient", static_cast<std::size_t>(9 * rows.slots()));
}

template <class B>
void Level<B>::element_force(const State<B>& at, double time, const Vectors<B>& force) {
  ++evaluations_;
  timed("force", [&] {
    if (viscosity) viscosity->prepare_at(exec(), *this, time);
    elasticity_->force(exec(), *this, at, ++evaluation_);
    if (viscosity) add_relaxed_force<B>(exec(), *this, at.u);
    gather_forces<B>(exec(), this->model, this->partial, gravity_, force);
  });
}

template <class B>
void Level<B>::add_loads(double time, const Vectors<B>& force) const {
  for (const Load<B>& load : this->loads)
    add_load<B>(exec(), load, load_factor(load.course, time), force);
}

template <class B>
GivenPressure<B> Level<B>::given_pressure(const FollowerLoad<B>& load, double time) const {
  return {static_cast<typename B::Real>(load.pressure * load_factor(load.course, time))};
}

template <class B>
void Level<B>::add_followers(const State<B>& at, double time, const Vectors<B>& force) {
  follower_time_ = time;
  const auto add = [&]<class Pressure>(const FollowerLoad<B>& load, const Pressure& pressure) {
    update_vertices<B>(exec(), "plica::follower_pressure", load.count,
                       AddFollowerPressure<B, Pressure>{{load, at.u}, force, pressure});
  };
  for (const FollowerLoad<B>& load : this->followers) {
    if (load.cavity) {
      measure(load, at.u);
      add(load, last_pressure(load, time));
    } else {
      add(load, given_pressure(load, time));
    }
  }
}

template <class B>
void Level<B>::add_follower_product(const State<B>& at, const Vectors<B>& p, double scale,
                                    bool projected, const Vectors<B>& q) const {
  const auto add = [&]<class Pressure>(const FollowerPlaces<B>& place, const Pressure& pressure) {
    update_vertices<B>(exec(), "plica::follower_product", place.load.count,
                       AddFollowerProduct<B, Pressure>{place, p, q, pressure,
                                                       static_cast<typename B::Real>(scale)});
  };
  for (const FollowerLoad<B>& load : this->followers) {
    const FollowerPlaces<B> place{load, at.u};
    if (!load.cavity) {
      if (!projected) add(place, given_pressure(load, follower_time_));
      continue;
    }
    const FluidPressure<B> fluid = last_pressure(load, follower_time_);
    if (!projected) add(place, fluid);
    reduce<B, 1>(exec(), "plica::volume_rate", load.count, VolumeRateOfCorner<B>{place, p},
                 volumes_, rate_);
    update_vertices<B>(exec(), "plica::fluid_product", load.count,
                       AddFluidProduct<B>{place, q, rate_, fluid.stiffness, scale});
  }
}

template <class B>
void Level<B>::add_product_beside_matrix(const State<B>& at, const Vectors<B>& p,
                                         const ImplicitWeights& weights, bool projected,
                                         const Vectors<B>& q) const {
  add_follower_product(at, p, weights.a, projected, q);
  if (contact_) response_.add_product(exec(), *this, p, true, q);
}

template <class B>
double Level<B>::follower_energy(double time) const {
  double sum = 0;
  for (const FollowerLoad<B>& load : this->followers) {
    if (load.volume.extent(0) == 0) continue;
    const double volume = enclosed_volume(load),
                 pressure = load.pressure * load_factor(load.course, time);
    if (!load.cavity)
      sum -= pressure * volume;
    else
      sum += load.cavity->stiffness() / 2 * std::pow(volume_given(load, time) - volume, 2);
  }
  return sum;
}

template <class B>
void Level<B>::measure(const FollowerLoad<B>& load, const Vectors<B>& u) const {
  reduce<B, 1>(exec(), "plica::enclosed_volume", load.count, VolumeOfCorner<B>{{load, u}}, volumes_,
               load.volume);
}

template <class B>
double Level<B>::enclosed_volume(const FollowerLoad<B>& load) const {
  measure(load, this->state.u);
  return host_values(exec(), load.volume)[0];
}

template <class B>
FluidPressure<B> Level<B>::last_pressure(const FollowerLoad<B>& load, double time) const {
  return {load.volume, volume_given(load, time), load.cavity->stiffness()};
}

template <class B>
double Level<B>::volume_given(const FollowerLoad<B>& load, double time) const {
  return load.cavity->goal(load_factor(load.course, time)) - load.cavity->caps;
}

template <class B>
std::vector<CavityState> Level<B>::cavities(double time) const {
  std::vector<CavityState> all;
  for (const FollowerLoad<B>& load : this->followers) {
    if (!load.cavity) continue;
    const double volume = enclosed_volume(load), lacking = volume_given(load, time) - volume;
    all.push_back(
        {load.cavity->load, volume + load.cavity->caps, load.cavity->stiffness() * lacking});
  }
  return all;
}

template <class B>
void Level<B>::evaluate(const State<B>& at, double time, const Vectors<B>& force,
                        const ContactStep& step, double weight) {
  evaluate_without_contact(at, time, force);
  if (!contact_) return;
  timed("contact", [&] {
    response_.add_forces(exec(), *this, at, time, step, force);
    if (weight > 0) response_.add_impulse(exec(), *this, at, time, weight);
  });
}

template <class B>
void Level<B>::count_contact(double time, const CarriedImpulse& of) {
  timed("contact", [&] { response_.add_impulse(exec(), *this, this->state, time, of); });
}

template <class B>
void Level<B>::evaluate_without_contact(const State<B>& at, double time, const Vectors<B>& force) {
  element_force(at, time, force);
  add_loads(time, force);
  add_followers(at, time, force);
  if (external_) timed("external", [&] { ask_caller(at, time, 0, 0, force); });
  add_correction(force);
}

template <class B>
void Level<B>::dead_loads(double time, const Vectors<B>& force) const {
  update_vertices<B>(exec(), "plica::weigh_vertices", this->model.vertices,
                     WeighVertices<B>{this->model.mass, gravity_, force});
  add_loads(time, force);
  add_correction(force);
}

template <class B>
void Level<B>::linearise(const State<B>& at, double time, const ImplicitWeights& weights,
                         double ahead, const Vectors<B>& force) {
  element_force(at, time + ahead, force);
  if (this->nodal.gradient.extent(0) > 0)
    keep_gradients<B>(exec(), *this, at.u), linearised_ = at.u;
  add_loads(time + ahead, force);
  add_followers(at, time + ahead, force);
  if (external_) timed("external", [&] { ask_caller(at, time, weights.ratio(), ahead, force); });
  add_correction(force);
}

template <class B>
void Level<B>::set_external(const ExternalForces<B>& forces, const Vectors<B>& rest) {
  external_ = forces;
  rest_ = rest;
  external_stiffness_ =
      implicit_ && forces ? Blocks<B>("plica::external.stiffness", rest.extent(0)) : Blocks<B>();
}

template <class B>
void Level<B>::ask_caller(const State<B>& at, double time, double step, double ahead,
                          const Vectors<B>& force) {
  if (implicit_) fill(exec(), external_stiffness_, typename B::Real(0));
  launch_gathered<typename B::Exec>();
  const typename LaunchQueue<typename B::Exec>::Scope at_once(nullptr);
  external_({exec(), number_, time, rest_, at.u, at.v, force, this->surface, step, ahead,
             external_stiffness_});
}

template <class B>
void Level<B>::add_correction(const Vectors<B>& force) const {
  if (correction_.extent(0) > 0) add<B>(exec(), "plica::add_correction", 1, correction_, force);
}

template <class B>
void Level<B>::incremental_energy(const State<B>& at) const {
  elasticity_->energy(exec(), *this, at.u);
  if (viscosity) add_relaxed_energy<B>(exec(), *this, at.u);
}

template <class B>
void Level<B>::keep_tangents() {
  const NodalRows<B>& rows = this->model.rows;
  if (!keeps_tangents(rows) || this->nodal.gradient.extent(0) == 0) return;
  if (this->nodal.tangent.extent(0) == 0)
    this->nodal.tangent = zeros<Scalars<B>>(
        "plica::nodal.tangent", symmetric_nine * static_cast<std::size_t>(rows.slots()));
  elasticity_->keep_tangents(exec(), *this);
}

template <class B>
void Level<B>::tangent(const State<B>& at, const Vectors<B>& p, double damping_scale,
                       bool projected) const {
  elasticity_->tangent(exec(), *this, state_or_cached(at), p, damping_scale, projected);
}

template <class B>
void Level<B>::product(const State<B>& at, const Vectors<B>& p, const ImplicitWeights& weights,
                       bool projected, const Vectors<B>& q) const {
  using Real = typename B::Real;
  const Exec& exec = clock_->exec();
  const Real a = static_cast<Real>(weights.a), b = static_cast<Real>(weights.b);
  tangent(at, p, weights.b / weights.a, projected);
  update_vertices<B>(exec, "plica::system_product", this->model.vertices,
                     SystemProduct<B>{this->model, p, this->partial, q, a, b});
  add_follower_product(at, p, weights.a, projected, q);
  add_product_beside_elements(p, weights, q);
}

template <class B>
void Level<B>::add_product_beside_elements(const Vectors<B>& p, const ImplicitWeights& weights,
                                           const Vectors<B>& q) const {
  if (contact_) response_.add_product(exec(), *this, p, false, q);
  if (external_)
    update_vertices<B>(
        exec(), "plica::external_product", this->model.vertices,
        AddBlockProduct<B>{external_stiffness_, p, q, static_cast<typename B::Real>(weights.a)});
}

template <class B>
void Level<B>::diagonal(const State<B>& at, const ImplicitWeights& weights, bool projected,
                        const Blocks<B>& blocks) const {
  using Real = typename B::Real;
  const Exec& exec = clock_->exec();
  const Real a = static_cast<Real>(weights.a), b = static_cast<Real>(weights.b);
  for (int direction = 0; direction < 3; ++direction) {
    elasticity_->diagonal(exec, *this, state_or_cached(at), direction, weights.b / weights.a,
                          projected);
    update_vertices<B>(exec, "plica::diagonal_column", this->model.vertices,
                       DiagonalColumn<B>{this->model, this->partial, blocks, a, b, direction});
  }
  if (external_) add<B>(exec, "plica::external_diagonal", a, external_stiffness_, blocks);
}

template <class B>
void Level<B>::assemble(const State<B>& at, const ImplicitWeights& weights, bool projected,
                        const PatchPairs<B>& pairs, const Blocks9<B>& shares,
                        const BlockMatrix<B>& A) const {
  const Exec& exec = clock_->exec();
  elasticity_->blocks(exec, this->model, pairs, at.u, weights, projected, shares, A);
  if (contact_) response_.add_matrix(exec, *this, 1, A);
  if (external_)
    update_vertices<B>(
        exec, "plica::external_matrix", this->model.vertices,
        AddToDiagonal<B>{external_stiffness_, A, static_cast<typename B::Real>(weights.a)});
}

template <class B>
void Level<B>::reset_history() {
  if (contact_) response_.reset_history(exec());
  integrator->reset_history();
}

template <class B>
void Level<B>::persist(Archive<B>& archive, const std::string& name) {
  archive.state(name + "state", this->state);
  archive.state(name + "start", this->start);
  archive.state(name + "previous", this->previous);
  archive.number(evaluations_);
  if (contact_) response_.persist(archive, name);
  if (viscosity) viscosity->persist(archive, *this, name);
  integrator->persist(archive);
}

#define PLICA_INSTANTIATE(Real, Exec) template class Level<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
