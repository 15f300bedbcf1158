// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/contact_response.hpp>
#include <plica/drivers/solver/pair_search.hpp>
#include <plica/kernels/contact/find_on_faces.hpp>
#include <plica/kernels/contact/find_pairs.hpp>
#include <plica/kernels/contact/implicit_response.hpp>
#include <plica/kernels/contact/linearised.hpp>
#include <plica/kernels/contact/wrenches.hpp>

namespace plica {

namespace {

constexpr int contact_sweeps = 3;

/// As in a whole macro step, of which this one is a part.
ContactStep of_whole_step(const ContactStep& step, double part) {
  return {step.span / part, step.ahead / part, step.entry / part, step.damped / part};
}

}  // namespace

template <class B>
ContactResponse<B>::ContactResponse(std::shared_ptr<const Contact<B>> contact, int vertices, bool implicit)
    : contact_(std::move(contact)),
      points_(contact_->make_points(implicit)),
      blocks_(std::max(contact_->sites(), 2 * contact_->points())),
      smooth_(zeros<Vectors<B>>("plica::contact.free", static_cast<std::size_t>(vertices))),
      answer_(zeros<Vectors<B>>("plica::contact.answer", static_cast<std::size_t>(vertices))),
      reached_(zeros<Indices<B>>("plica::contact.reached", static_cast<std::size_t>(vertices))),
      sums_(zeros<Doubles<B>>("plica::contact.wrench", 6)),
      impulse_(zeros<Doubles<B>>("plica::contact.impulse", static_cast<std::size_t>(6 * contact_->wrenches()))) {
  if (points_.pairs.triangles > 0) search_ = std::make_shared<const PairSearch<B>>(contact_->limits(), points_);
}

template <class B>
void ContactResponse<B>::find(const Exec& exec, const Level<B>& level, const State<B>& state, double time, double ahead,
                              const TouchingPoints<B>& points) const {
  contact_->find(exec, level, state, time, ahead, points);
  if (search_) search_->find(exec, level.surface, state, points, blocks_);
}

/// Where points get forces of pairs or faces, see SumPointForces.
template <class B>
void ContactResponse<B>::sum_up(const Exec& exec, bool bounding) const {
  if (points_.pairs.sum.extent(0) > 0)
    where_touching<B>(exec, points_.count, "plica::contact_sum", contact_->points(),
                      SumPointForces<B>{points_, bounding});
}

template <class B>
void ContactResponse<B>::solve(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
                               const ContactStep& step, TouchLaw<B> law, const Respond& respond) const {
  const int n = contact_->sites();
  law.h = static_cast<Real>(step.span), law.ahead = static_cast<Real>(step.ahead);
  law.entry = static_cast<Real>(step.entry);
  law.points.span = law.h;
  find(exec, level, state, time, 0, law.points);
  reduce<B, 1>(exec, "plica::contact_start", n, StartTouching<B>{law}, blocks_, points_.count);
  sum_up(exec, law.isotropic);
  for (int sweep = 0; sweep <= contact_sweeps; ++sweep) {  // the first for rho and the forces by e alone
    if (sweep == 0 || step.span > 0) respond();
    where_touching<B>(exec, points_.count, "plica::contact_sweep", n, SweepTouching<B>{law, sweep == 0});
    sum_up(exec);
    if (!(step.span > 0)) break;
  }
}

template <class B>
void ContactResponse<B>::resolve(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
                                 const ContactStep& step, const Vectors<B>& smooth, const Vectors<B>& answer,
                                 const Respond& respond) const {
  solve(exec, level, state, time, of_whole_step(step, part_),
        {level.surface, all_points(), smooth, answer, 0, 0, 0, true, false}, respond);
}

template <class B>
void ContactResponse<B>::add_forces(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
                                    const ContactStep& given, const Vectors<B>& f) {
  const int touched = level.surface.touched;
  const ContactStep step = of_whole_step(given, part_);
  const Real damped = static_cast<Real>(step.damped);
  update_vertices<B>(exec, "plica::contact_smooth", touched,
                     FreeAcceleration<B>{level.surface, level.model, f, state.v, smooth_, damped});
  AnswerByMass<B> answer{level.surface, level.model, points_, answer_, reached_, damped, true};
  solve(exec, level, state, time, step, {level.surface, points_, smooth_, answer_, 0, 0, 0, false, true}, [&] {
    where_touching<B>(exec, points_.count, "plica::contact_answer", touched, answer);
    answer.first = false;
  });
  scatter(exec, level, f, reached_);
}

template <class B>
void ContactResponse<B>::forget_impulse(const Exec& exec) const {
  fill(exec, impulse_, 0);
}

template <class B>
void ContactResponse<B>::add_impulse(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
                                     double weight) const {
  for (int o = 0; o < contact_->obstacles(); ++o) {
    reduce<B, 6>(exec, "plica::contact_wrench", contact_->sites(),
                 ObstacleWrench<B>{level.surface, state.u, points_, o, contact_->place(o, time)}, blocks_, sums_,
                 AddImpulse<B>{sums_, impulse_, 6 * o, weight});
  }
  for (int b = 0; b < contact_->touching_bodies(); ++b) {
    reduce<B, 6>(exec, "plica::contact_wrench", level.surface.points, BodyWrench<B>{level.surface, state.u, points_, b},
                 blocks_, sums_, AddImpulse<B>{sums_, impulse_, 6 * (contact_->obstacles() + b), weight});
  }
}

template <class B>
double ContactResponse<B>::energy(const Exec& exec, const Level<B>& level, double time) const {
  double total = contact_->energy(exec, level, time, blocks_);
  if (!contact_->couples()) return total;
  const auto result = zeros<Doubles<B>>("plica::contact_energy", 1);
  find(exec, level, level.state, time, 0, all_points());
  if (search_) {
    reduce<B, 1>(exec, "plica::pair_energy", 2 * level.surface.points, PairEnergy<B>{points_}, blocks_, result);
    total += host_values(exec, result)[0];
  }
  if (contact_->whole() > 0) {
    reduce<B, 1>(exec, "plica::face_energy", points_.faces.triangles, FaceEnergy<B>{points_}, blocks_, result);
    total += host_values(exec, result)[0];
  }
  return total;
}

template <class B>
std::vector<double> ContactResponse<B>::depths(const Exec& exec, const Level<B>& level, double time) const {
  const TouchingPoints<B> points = all_points();
  contact_->find(exec, level, level.state, time, 0, points);
  std::vector<double> all;
  for (int o = 0; o < contact_->obstacles(); ++o) {
    reduce<B, 1, DepthInObstacle<B>, Sums<1, 1>>(exec, "plica::contact_depth", contact_->sites(), {points, o}, blocks_,
                                                 sums_);
    all.push_back(host_values(exec, sums_)[0]);
  }
  return all;
}

template <class B>
void ContactResponse<B>::linearise(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
                                   const ImplicitWeights& w, double ahead, const Vectors<B>& f) {
  points_.span = static_cast<Real>(ahead);
  weights_ = w, ahead_ = ahead;
  find(exec, level, state, time, ahead, all_points());
  reduce<B, 1>(exec, "plica::contact_linearise", contact_->sites(), last_law(), blocks_, points_.count);
  sum_up(exec);
  scatter(exec, level, f);
}

template <class B>
LineariseTouching<B> ContactResponse<B>::last_law() const {
  return {points_, static_cast<Real>(ahead_), static_cast<Real>(weights_.a), static_cast<Real>(weights_.b)};
}

template <class B>
void ContactResponse<B>::move_linearised(const Exec& exec, const Level<B>& level, const Vectors<B>& change,
                                         const Vectors<B>& r) {
  reduce<B, 1>(exec, "plica::contact_move", contact_->sites(), MoveTouching<B>{level.surface, change, last_law()},
               blocks_, points_.count);
  ahead_ = 0;
  sum_up(exec);
  scatter(exec, level, r);
}

/// f += W^T of the last forces
template <class B>
void ContactResponse<B>::scatter(const Exec& exec, const Level<B>& level, const Vectors<B>& f,
                                 const Indices<B>& reached) const {
  where_touching<B>(exec, points_.count, "plica::contact_scatter", level.surface.touched,
                    ScatterContact<B>{level.surface, points_, f, reached});
}

template <class B>
void ContactResponse<B>::add_product(const Exec& exec, const Level<B>& level, const Vectors<B>& p, bool beside,
                                     const Vectors<B>& q) const {
  if (beside && !contact_->couples()) return;
  where_touching<B>(exec, points_.count, "plica::contact_product", contact_->sites(),
                    ContactProduct<B>{level.surface, p, points_, beside});
  sum_up(exec);
  scatter(exec, level, q);
}

template <class B>
void ContactResponse<B>::add_diagonal(const Exec& exec, const Level<B>& level, bool beside,
                                      const Blocks<B>& diagonal) const {
  if (beside && !contact_->couples()) return;
  where_touching<B>(exec, points_.count, "plica::contact_diagonal", level.surface.touched,
                    AddContactBlocks<B>{level.surface, points_, beside, diagonal});
}

template <class B>
void ContactResponse<B>::add_matrix(const Exec& exec, const Level<B>& level, double scale,
                                    const BlockMatrix<B>& A) const {
  where_touching<B>(exec, points_.count, "plica::contact_matrix", level.surface.touched,
                    AddContactToMatrix<B>{level.surface, points_, static_cast<Real>(scale), A});
}

template <class B>
std::size_t ContactResponse<B>::bytes() const {
  const std::size_t reals = 4 * points_.normal.span() + points_.faces.weight.span() + points_.faces.kept.span() +
                            2 * points_.depth.span() + points_.block.span() + points_.concavity.span() +
                            smooth_.span() + answer_.span();
  return reals * sizeof(Real) + (search_ ? search_->bytes() : 0);
}

#define PLICA_INSTANTIATE(Real, Exec) template class ContactResponse<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
