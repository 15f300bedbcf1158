// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/level_forces.hpp>
#include <plica/drivers/solver/load_factor.hpp>
#include <plica/kernels/elastic/gather_forces.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/linear/vertex_blocks.hpp>
#include <plica/kernels/loads/add_load.hpp>

namespace plica {

template <class B>
LevelForces<B>::LevelForces(std::shared_ptr<const Elasticity<B>> elasticity, const Point& gravity,
                            std::shared_ptr<const Contact<B>> contact, bool implicit, StageClock<B>* clock, int level)
    : elasticity_(std::move(elasticity)),
      contact_(std::move(contact)),
      implicit_(implicit),
      clock_(clock),
      level_(level) {
  for (int k = 0; k < 3; ++k) gravity_[k] = static_cast<typename B::Real>(gravity[k]);
  if (contact_) points_ = contact_->make_points(implicit);
}

template <class B>
void LevelForces<B>::elastic_and_gravity(const Level<B>& level, const State<B>& state, const Vectors<B>& f) {
  ++evaluations_;
  book("force", [&] {
    elasticity_->force(clock_->exec(), level.model.patches, state, level.flags, ++evaluation_, level.partial);
    gather_forces<B>(clock_->exec(), level.model, level.partial, gravity_, f);
  });
}

template <class B>
void LevelForces<B>::add_loads(const Level<B>& level, double time, const Vectors<B>& f) const {
  for (const Load<B>& load : level.loads) add_load<B>(clock_->exec(), load, load_factor(load.course, time), f);
}

template <class B>
void LevelForces<B>::evaluate(const Level<B>& level, const State<B>& state, double time, const Vectors<B>& f) {
  evaluate_without_contact(level, state, time, f);
  if (contact_) book("contact", [&] { contact_->add_forces(clock_->exec(), level, state, time, points_, f); });
}

template <class B>
void LevelForces<B>::evaluate_without_contact(const Level<B>& level, const State<B>& state, double time,
                                              const Vectors<B>& f) {
  elastic_and_gravity(level, state, f);
  add_loads(level, time, f);
  if (external_) book("external", [&] { ask_caller(level, state, time, 0, 0, f); });
  add_correction(f);
}

template <class B>
void LevelForces<B>::dead(const Level<B>& level, double time, const Vectors<B>& f) const {
  update_vertices<B>(clock_->exec(), "plica::weigh_vertices", level.model.vertices,
                     WeighVertices<B>{level.model.mass, gravity_, f});
  add_loads(level, time, f);
  add_correction(f);
}

template <class B>
void LevelForces<B>::linearise(const Level<B>& level, const State<B>& state, double time,
                               const ImplicitWeights& weights, double ahead, const Vectors<B>& f) {
  elastic_and_gravity(level, state, f);
  add_loads(level, time + ahead, f);
  if (contact_)
    book("contact", [&] { contact_->linearise(clock_->exec(), level, state, time, weights, ahead, points_, f); });
  if (external_) book("external", [&] { ask_caller(level, state, time, weights.ratio(), ahead, f); });
  add_correction(f);
}

template <class B>
void LevelForces<B>::set_external(const ExternalForces<B>& forces, const Vectors<B>& rest) {
  external_ = forces;
  rest_ = rest;
  external_stiffness_ = implicit_ && forces ? Blocks<B>("plica::external.stiffness", rest.extent(0)) : Blocks<B>();
}

template <class B>
void LevelForces<B>::ask_caller(const Level<B>& level, const State<B>& state, double time, double step, double ahead,
                                const Vectors<B>& f) {
  if (implicit_) Kokkos::deep_copy(clock_->exec(), external_stiffness_, typename B::Real(0));
  external_(
      {clock_->exec(), level_, time, rest_, state.u, state.v, f, level.surface, step, ahead, external_stiffness_});
}

template <class B>
void LevelForces<B>::add_correction(const Vectors<B>& f) const {
  if (correction_.extent(0) > 0)
    update_vertices<B>(clock_->exec(), "plica::add_correction", static_cast<int>(f.extent(0)),
                       AddVectors<B>{correction_, f});
}

template <class B>
void LevelForces<B>::tangent(const Level<B>& level, const State<B>& state, const Vectors<B>& p, double over) const {
  elasticity_->tangent(clock_->exec(), level.model.patches, state.u, p, over, level.partial);
}

template <class B>
void LevelForces<B>::product(const Level<B>& level, const State<B>& state, const Vectors<B>& p,
                             const ImplicitWeights& weights, const Vectors<B>& q) const {
  using Real = typename B::Real;
  const auto& exec = clock_->exec();
  const Real a = static_cast<Real>(weights.a), b = static_cast<Real>(weights.b);
  tangent(level, state, p, weights.b / weights.a);
  update_vertices<B>(exec, "plica::system_product", level.model.vertices,
                     SystemProduct<B>{level.model, p, level.partial, q, a, b});
  if (contact_) contact_->add_product(exec, level, p, points_, q);
  if (external_)
    update_vertices<B>(exec, "plica::external_product", level.model.vertices,
                       AddBlockProduct<B>{external_stiffness_, p, q, a});
}

template <class B>
void LevelForces<B>::diagonal(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights,
                              const Blocks<B>& blocks) const {
  using Real = typename B::Real;
  const auto& exec = clock_->exec();
  const Real a = static_cast<Real>(weights.a), b = static_cast<Real>(weights.b);
  for (int direction = 0; direction < 3; ++direction) {
    elasticity_->diagonal(exec, level.model.patches, state.u, direction, weights.b / weights.a, level.partial);
    update_vertices<B>(exec, "plica::diagonal_column", level.model.vertices,
                       DiagonalColumn<B>{level.model, level.partial, blocks, a, b, direction});
  }
  if (contact_) contact_->add_diagonal(exec, level, points_, blocks);
  if (external_)
    update_vertices<B>(exec, "plica::external_diagonal", level.model.vertices,
                       AddBlocks<B>{external_stiffness_, blocks, a});
}

template <class B>
void LevelForces<B>::assemble(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights,
                              bool positive, const PatchPairs<B>& pairs, const Blocks9<B>& shares,
                              const BlockMatrix<B>& A) const {
  const auto& exec = clock_->exec();
  elasticity_->blocks(exec, level.model, pairs, state.u, weights, positive, shares, A);
  if (contact_) contact_->add_matrix(exec, level, points_, A);
  if (external_)
    update_vertices<B>(exec, "plica::external_matrix", level.model.vertices,
                       AddToDiagonal<B>{external_stiffness_, A, static_cast<typename B::Real>(weights.a)});
}

#define PLICA_INSTANTIATE(Real, Exec) template class LevelForces<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
