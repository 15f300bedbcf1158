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
#include <plica/kernels/halo.hpp>
#include <plica/kernels/linear/vertex_blocks.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/kernels/vectors.hpp>
#include <utility>

namespace plica {

template <class B>
Level<B>::Level(LevelData<B>&& data, StageTimer<B>& clock, int number)
    : LevelData<B>(std::move(data)), clock_(&clock), number_(number) {}
template <class B>
Level<B>::Level(Level&&) noexcept = default;
template <class B>
Level<B>::~Level() = default;

template <class B>
void Level<B>::set_forces(std::shared_ptr<const Elasticity<B>> elasticity, const Point& gravity,
                          std::shared_ptr<const Contact<B>> contact, bool implicit) {
  elasticity_ = std::move(elasticity), contact_ = std::move(contact), implicit_ = implicit;
  set_gravity(gravity);
  if (contact_) response_ = ContactResponse<B>(contact_, *this, implicit);
  const NodalRows<B>& rows = this->model.rows;
  // not with smoothed pressures, which need both fields once more
  if (implicit && rows.slices > 0 && rows.bulk_excess.extent(0) == 0)
    this->nodal.gradient =
        zeros<Scalars<B>>("plica::nodal.gradient", static_cast<std::size_t>(9 * rows.slots()));
}

template <class B>
void Level<B>::set_gravity(const Point& gravity) {
  for (int k = 0; k < 3; ++k) gravity_[k] = static_cast<typename B::Real>(gravity[k]);
}

template <class B>
void Level<B>::element_force(const State<B>& at, double time, const Vectors<B>& force) {
  ++evaluations_;
  timed("force", [&] {
    if (viscosity) viscosity->prepare_at(exec(), *this, time);
    elasticity_->force(exec(), *this, at, ++evaluation_);
    if (viscosity) add_relaxed_force<B>(exec(), *this, at.u);
    complete_shares<B>(exec(), *this);
    gather_forces<B>(exec(), this->model, this->partial, gravity_, force);
  });
}

template <class B>
void Level<B>::add_term_product(const State<B>& at, const Vectors<B>& p, double scale,
                                bool projected, const Vectors<B>& q) const {
  for (const auto& term : terms) term->add_product(exec(), at, p, scale, projected, q);
  collect(q);
}

template <class B>
bool Level<B>::has_terms(TermStiffness kind) const {
  return std::ranges::any_of(terms, [&](const auto& term) { return term->stiffness() == kind; });
}

template <class B>
double Level<B>::term_energy(double time) const {
  double sum = 0;
  for (const auto& term : terms) sum += term->energy(exec(), this->state, time);
  return sum;
}

template <class B>
double Level<B>::term_frequency() const {
  double sum = 0;
  for (const auto& term : terms) sum += term->squared_frequency(*this);
  return sum;
}

template <class B>
std::vector<CavityState> Level<B>::cavities(double time) const {
  std::vector<CavityState> all;
  for (const auto& term : terms)
    for (const CavityState& cavity : term->cavities(exec(), this->state, time))
      all.push_back(cavity);
  return all;
}

template <class B>
void Level<B>::add_product_beside_matrix(const State<B>& at, const Vectors<B>& p,
                                         const ImplicitWeights& weights, bool projected,
                                         const Vectors<B>& q) const {
  for (const auto& term : terms)
    if (term->stiffness() == TermStiffness::unassembled)
      term->add_product(exec(), at, p, weights.a, projected, q);
  if (contact_) response_.add_product(exec(), *this, p, true, q);
  collect(q);
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
  hold_sliding(exec(), *this, force);
}

template <class B>
void Level<B>::count_contact(double time, const CarriedImpulse& of) {
  timed("contact", [&] { response_.add_impulse(exec(), *this, this->state, time, of); });
}

template <class B>
void Level<B>::evaluate_without_contact(const State<B>& at, double time, const Vectors<B>& force) {
  element_force(at, time, force);
  for (const auto& term : terms) term->add_force(exec(), at, time, force);
  if (external_) timed("external", [&] { ask_caller(at, time, 0, 0, force); });
  add_correction(force);
  collect(force);
  hold_sliding(exec(), *this, force);
}

template <class B>
void Level<B>::collect(const Vectors<B>& force) const {
  if (!terms.empty() || external_ || correction_.extent(0) > 0)
    collect_followers(exec(), this->model, force);
}

template <class B>
void Level<B>::measure_forces(double time, const Vectors<B>& force) {
  const ElementFlags<B> kept = std::exchange(this->flags, {});
  if (viscosity) viscosity->prepare_at(exec(), *this, time);
  elasticity_->force(exec(), *this, this->state, evaluation_);
  if (viscosity) add_relaxed_force<B>(exec(), *this, this->state.u);
  complete_shares<B>(exec(), *this);
  this->flags = kept;
  gather_forces<B>(exec(), this->model, this->partial, gravity_, force);
  for (const auto& term : terms) term->add_force(exec(), this->state, time, force);
  add_correction(force);
  collect(force);
  if (contact_) response_.add_last_forces(exec(), *this, force);
}

template <class B>
void Level<B>::dead_loads(double time, const Vectors<B>& force) const {
  update_vertices<B>(exec(), "plica::weigh_vertices", this->model.vertices,
                     WeighVertices<B>{this->model.mass, gravity_, force});
  for (const auto& term : terms)
    if (term->stiffness() == TermStiffness::none) term->add_force(exec(), this->state, time, force);
  add_correction(force);
  collect(force);
}

template <class B>
void Level<B>::linearise(const State<B>& at, double time, const ImplicitWeights& weights,
                         double ahead, const Vectors<B>& force) {
  element_force(at, time + ahead, force);
  if (this->nodal.gradient.extent(0) > 0)
    keep_gradients<B>(exec(), *this, at.u), linearised_ = at.u;
  for (const auto& term : terms) term->add_force(exec(), at, time + ahead, force);
  if (external_) timed("external", [&] { ask_caller(at, time, weights.ratio(), ahead, force); });
  add_correction(force);
  collect(force);
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
  complete_shares<B>(exec(), *this);
}

template <class B>
void Level<B>::keep_tangents(const State<B>& at) {
  const NodalRows<B>& rows = this->model.rows;
  const bool by_rows = rows.slices > 0;
  if (by_rows && (!keeps_tangents(rows) || this->nodal.gradient.extent(0) == 0)) return;
  const int slots = by_rows ? rows.slots() : this->model.patches.packs * B::lanes;
  if (this->nodal.tangent.extent(0) == 0)
    this->nodal.tangent =
        zeros<Scalars<B>>("plica::nodal.tangent", symmetric_nine * static_cast<std::size_t>(slots));
  elasticity_->keep_tangents(exec(), *this, at.u);
}

template <class B>
void Level<B>::tangent(const State<B>& at, const Vectors<B>& p, double damping_scale,
                       bool projected) const {
  follow_masters(exec(), this->model, p);
  elasticity_->tangent(exec(), *this, state_or_cached(at), p, damping_scale, projected);
  complete_shares<B>(exec(), *this);
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
  for (const auto& term : terms)
    if (term->stiffness() == TermStiffness::unassembled)
      term->add_product(exec, at, p, weights.a, projected, q);
  add_product_beside_elements(p, weights, q);
}

template <class B>
void Level<B>::add_product_beside_elements(const Vectors<B>& p, const ImplicitWeights& weights,
                                           const Vectors<B>& q) const {
  for (const auto& term : terms)
    if (term->stiffness() == TermStiffness::assembled)
      term->add_product(exec(), this->state, p, weights.a, false, q);
  if (contact_) response_.add_product(exec(), *this, p, false, q);
  if (external_)
    update_vertices<B>(
        exec(), "plica::external_product", this->model.vertices,
        AddBlockProduct<B>{external_stiffness_, p, q, static_cast<typename B::Real>(weights.a)});
  collect(q);
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
    complete_shares<B>(exec, *this);
    update_vertices<B>(exec, "plica::diagonal_column", this->model.vertices,
                       DiagonalColumn<B>{this->model, this->partial, blocks, a, b, direction});
  }
  for (const auto& term : terms) term->add_diagonal(exec, at, weights.a, blocks);
  if (external_) add<B>(exec, "plica::external_diagonal", a, external_stiffness_, blocks);
}

template <class B>
void Level<B>::assemble(const State<B>& at, const ImplicitWeights& weights, bool projected,
                        const PatchPairs<B>& pairs, const Blocks9<B>& shares,
                        const BlockMatrix<B>& A) const {
  const Exec& exec = clock_->exec();
  share_vertices<B>(exec, *this, at.u);
  elasticity_->blocks(exec, model_of_matrix<B>(*this), pairs, at.u, weights, projected, shares, A);
  for (const auto& term : terms) term->add_blocks(exec, at, weights.a, A);
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
void Level<B>::name_fields(Archive<B>& archive, const std::string& name) {
  archive.state(name + "state", this->state);
  archive.state(name + "start", this->start);
  archive.state(name + "previous", this->previous);
  archive.number(evaluations_);
  if (contact_) response_.name_fields(archive, name, exec(), *this);
  if (viscosity) viscosity->name_fields(archive, *this, name);
  integrator->name_fields(archive);
}

#define PLICA_INSTANTIATE(Real, Exec) template class Level<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
