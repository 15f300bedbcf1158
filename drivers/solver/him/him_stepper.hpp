// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <functional>
#include <plica/core/level.hpp>
#include <plica/drivers/solver/him/inertia.hpp>
#include <plica/drivers/solver/regaining.hpp>
#include <plica/drivers/solver/stepper.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/him/leapfrog.hpp>
#include <plica/kernels/him/momentum_of.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// For bodies that nothing holds: A' = (1 - T) A (1 - T)^T + 1 1^T / mass, T the mean by mass; and momenta without rigid motion.
template <class B>
class FreeMotion {
 public:
  using Exec = typename B::Exec;
  explicit FreeMotion(const Vectors<B>& rest)
      : rest_(rest),
        blocks_(static_cast<int>(rest.extent(0))),
        sums_(zeros<Doubles<B>>("plica::free.moments", 16)),
        total_(zeros<Doubles<B>>("plica::free.total", 4)),
        frame_("plica::free.frame") {}

  /// Notes the sum of the momenta p; `rest`: what is not translation. With a count only where that is above 0.
  void take_translation(const Exec& exec, const Model<B>& model, const Vectors<B>& p, const Vectors<B>& rest,
                        const Doubles<B>& count) const {
    sum_where_touching<B, 4>(exec, count, "plica::free_total", model.vertices, SumOfMomenta<B>{model.mass, p}, blocks_,
                             total_);
    where_touching<B>(exec, count, "plica::free_take", model.vertices, TakeTranslation<B>{model.mass, p, rest, total_});
  }

  /// Makes it the sum of m v; likewise.
  void put_translation(const Exec& exec, const Model<B>& model, const Vectors<B>& v, const Doubles<B>& count) const {
    sum_where_touching<B, 4>(exec, count, "plica::free_total", model.vertices, SumOfMotion<B>{model.mass, v}, blocks_,
                             sums_);
    where_touching<B>(exec, count, "plica::free_put", model.vertices, PutTranslation<B>{v, total_, sums_});
  }

  /// The rigid part of p - m v at a state.
  RigidMotion<B> rigid_part(const Exec& exec, const Model<B>& model, const State<B>& state, const Vectors<B>& p) const {
    reduce<B, 16>(exec, "plica::free_moments", model.vertices, BodyMoments<B>{model.mass, rest_, state.u, p, state.v},
                  blocks_, sums_, SetRigidFrame<B>{sums_, frame_});
    return {rest_, state.u, frame_};
  }
  /// The kick, and what it leaves but for translation, whose sum is noted.
  void kick(const Exec& exec, const Model<B>& model, const KickMomentum<B>& kick, const Vectors<B>& rest) const {
    reduce<B, 4>(exec, "plica::him_momenta", model.vertices, KickAndSum<B>{kick}, blocks_, total_);
    update_vertices<B>(exec, "plica::free_take", model.vertices, TakeTranslation<B>{model.mass, kick.p, rest, total_});
  }
  /// a = (a - v) / t, of a = A p with the translation.
  void accelerate(const Exec& exec, const Model<B>& model, const Vectors<B>& v, const Vectors<B>& a, double t) const {
    reduce<B, 4>(exec, "plica::free_total", model.vertices, SumOfMotion<B>{model.mass, a}, blocks_, sums_);
    update_vertices<B>(exec, "plica::him_acceleration", model.vertices,
                       AccelerationOfTranslated<B>{{a, total_, sums_}, {v, a, static_cast<typename B::Real>(1 / t)}});
  }

 private:
  Vectors<B> rest_;
  BlockSums<B> blocks_;
  Doubles<B> sums_, total_;
  RigidFrameOf<B> frame_;
};

/// p with A p = v, by conjugate gradients preconditioned by the mass, to 1e-6 of v: at most sqrt(inertia added) iterations or so. Waits.
template <class B>
void momentum_of(const typename B::Exec& exec, const Model<B>& model,
                 const std::function<void(const Vectors<B>& p, const Vectors<B>& v)>& A, const Vectors<B>& v,
                 const Vectors<B>& p) {
  using Real = typename B::Real;
  constexpr int most_iterations = 300;
  constexpr double tolerance = 1e-6;
  const int n = model.vertices;
  const auto size = static_cast<std::size_t>(n);
  const auto r = zeros<Vectors<B>>("plica::momentum.r", size), s = zeros<Vectors<B>>("plica::momentum.s", size),
             As = zeros<Vectors<B>>("plica::momentum.As", size);
  const BlockSums<B> blocks(n);
  const auto sum = zeros<Doubles<B>>("plica::momentum.sum", 1);
  const auto read = [&](const auto& term) {
    reduce<B, 1>(exec, "plica::momentum", n, term, blocks, sum);
    return host_values(exec, sum)[0];
  };
  weigh<B>(exec, "plica::momentum", model, 1, v, 0, v, p);
  const double whole = read(StartResidual<B>{model, v, As, r});  // As is still 0
  A(p, As);
  double square = read(StartResidual<B>{model, v, As, r});
  double beta = 0;
  const double enough = tolerance * tolerance * whole;
  for (int i = 0; i < most_iterations && square > enough; ++i) {
    weigh<B>(exec, "plica::momentum", model, 1, r, static_cast<Real>(beta), s, s);
    A(s, As);
    dot<B>(exec, "plica::momentum", s, As, blocks, sum);
    const double alpha = square / host_values(exec, sum)[0];
    const double next = read(MoveAlong<B>{model, s, As, p, r, static_cast<Real>(alpha)});
    beta = next / square, square = next;
  }
}

/// What the stepper `him` is made of.
template <class B>
struct HimParts {
  HimOptions options;
  std::unique_ptr<InverseMass<B>> inverse_mass;
  std::unique_ptr<InertiaFitter<B>> fitter;
  std::optional<FreeMotion<B>> free;         ///< of a body that nothing holds
  Vectors<B> contact_force, contact_answer;  ///< of the vertices, with obstacles [N], [m/s^2]
  InertiaFit fit;
  /// The level by whose critical step an automatic one goes: without coarser meshes the one below a space for slivers.
  std::size_t detail = 0;
};

/// The hierarchical inverse mass: one V-cycle and one force evaluation, of the finest level, per macro step. Forces go down to
/// the coarser levels. Each level computes accelerations with the inertia of the motion that it can represent, and these are
/// interpolated back up. Motion that coarse levels represent keeps its own inertia. Finer detail gets more inertia: it is slowed,
/// and so allows the step. Static equilibrium is that of the finest mesh. Second order. See cmake/docs/him.md.
///
/// The momenta p are integrated, and v = A p. The scheme is symplectic Euler of the energy p.A(x) p/2 + V(x). The state is taken
/// half a step after the forces, so that at t_n and t_n+1 it is that of position Verlet. The energy stays bounded. Of a free body
/// sum p = sum m v and sum x x p are conserved; sum x x m v oscillates. A start from given velocities takes p = m v and v = A m v.
/// A state that is set later keeps its v, with p = A^-1 v and the axes of that moment. lost_stability() is true where the body has
/// stiffened beyond the stable step; repair() cuts the step and fits the inertia to the present state, lengthen() takes the longest of the
/// earlier fits that hold in it.
template <class B>
class HimStepper final : public Stepper<B> {
  using Real = typename B::Real;

 public:
  HimStepper() = default;
  /// Of parts that were put together by hand, for the finest level of this hierarchy.
  HimStepper(const Hierarchy<B>& h, HimParts<B>&& parts) { take(h, std::move(parts)); }

  void plan(StepperSetup<B>& setup) override;

  void start(Hierarchy<B>& h) override {
    const Level<B>& level = h[0];
    const auto& exec = h.exec();
    parts_.inverse_mass->turn(exec, level.state.u);
    weigh<B>(exec, "plica::him_momenta", level.model, 1, level.state.v, 0, level.state.v, p_);
    answer(exec, level.model, p_, a_);
    combine_free<B>(exec, "plica::him_start", level.model.inverse_mass, 1, a_, 0, a_, level.state.v);
    forget(exec);
  }

  void begin(Hierarchy<B>& h) override {
    const Level<B>& level = h[0];
    const auto& exec = h.exec();
    copy(exec, a_, level.state.u);
    const auto half = static_cast<Real>(0.5 * parts_.fit.step);
    combine_free<B>(exec, "plica::him_back", level.model.inverse_mass, -half, level.state.v, 1, a_, a_);
    parts_.inverse_mass->turn(exec, a_);
    has_momenta_ = false;
    forget(exec);
  }

  void step(Hierarchy<B>& h, double time, double t) override {
    if (!has_momenta_) find_momenta(h.exec(), h[0]);
    for (int s = 0; s < parts(); ++s) one(h, time + s * t / parts(), t / parts());
  }

  bool can_repair() const override { return may_repair_; }
  bool lost_stability(const Hierarchy<B>& h, double) override { return watched(h.exec()) > 0; }

  /// An impact strains elements by more than a long step can follow. Where stability is lost fast, energy that nobody put in shows it first.
  bool repairs(const Diagnosis&) const override { return may_repair_; }

  bool repair(Hierarchy<B>& h, double t) override;
  void lengthen(Hierarchy<B>& h, double t, long steps) override;

  int parts() const override { return 1 << halvings_; }

  /// p [kg m/s], 0 where the motion is given.
  const Vectors<B>& momenta() const { return p_; }

  std::map<std::string, long> counters() const override {
    return {{"inertia_refits", repairs_}, {"him_substeps", parts()}, {"substeps_regained", regaining_.count()}};
  }

  std::size_t bytes() const override {
    return parts_.inverse_mass->bytes() + parts_.fitter->bytes() + 5 * g_.span() * sizeof(Real) +
           (parts_.free ? g_.span() * sizeof(Real) : 0) + 2 * parts_.contact_force.span() * sizeof(Real);
  }

  void persist(StateArchive<B>& archive) override {
    const double macro_step = parts_.fit.step * parts();
    archive.number(halvings_), archive.number(repairs_);
    for (double& scale : scales_) archive.number(scale);
    regaining_.persist(archive);
    if (macro_step / parts() != parts_.fit.step || scale_at(halvings_) != parts_.fit.scale) use(macro_step);
    archive.number(first_), archive.number(has_momenta_);
    archive.field("the momenta", p_);
    archive.field("the axes' share of them", parts_.inverse_mass->axes().share());
    archive.field("the last force", f_before_);
    archive.field("the last answer", a_before_);
    archive.field("the coarsest axes", parts_.inverse_mass->filter().rotation);
    archive.field("how far they turned", turned_);
    archive.field("the last contact", contact_.force);
    archive.field("how much touched", contact_.touching);
  }

 private:
  HimParts<B> parts_;
  int n_ = 0;
  Vectors<B> p_, g_, a_, f_before_, a_before_;
  ContactForces<B> contact_;  ///< of the last step
  BlockSums<B> blocks_;
  Doubles<B> turned_, sums_, watch_;
  bool first_ = true, may_repair_ = true;
  bool has_momenta_ = true;                // else the next step finds them
  static constexpr int most_halvings = 6;  // of a step
  int halvings_ = 0;
  std::array<double, most_halvings + 1> scales_ = {};  // of the last fit with so many halvings; 0: none
  long repairs_ = 0;
  Regaining regaining_;

  using Count = typename InverseMass<B>::Count;

  /// Those of the velocities, about the axes as they are.
  void find_momenta(const typename B::Exec& exec, const Level<B>& level) {
    const auto A = [&](const Vectors<B>& p, const Vectors<B>& v) { answer(exec, level.model, p, v); };
    momentum_of<B>(exec, level.model, A, level.state.v, p_);
    has_momenta_ = true;
  }

  double& scale_at(int halvings) { return scales_[static_cast<std::size_t>(halvings)]; }
  /// The fit that there was with these halvings.
  void use(double macro_step) {
    parts_.fit = parts_.fitter->use(macro_step / parts(), parts_.options.sigma, scale_at(halvings_));
  }

  /// The parts, and work arrays that go with them.
  void take(const Hierarchy<B>& h, HimParts<B>&& parts);

  /// 0, or what is wrong: 1 the spectrum, 2 the axes' force. Waits.
  double watched(const typename B::Exec& exec) const {
    exec.fence("plica::him_watch");
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), watch_)(1);
  }

  /// What the next step takes from the last, but for momenta.
  void forget(const typename B::Exec& exec) {
    first_ = true;
    fill(exec, watch_, 0.0), fill(exec, turned_, 0.0);
    fill(exec, parts_.inverse_mass->axes().share(), Real(0));
    fill(exec, contact_.force, Real(0));
  }

  /// v = A p; with a count only where that is above 0.
  void answer(const typename B::Exec& exec, const Model<B>& model, const Vectors<B>& p, const Vectors<B>& v,
              const Count& count = {}) const {
    parts_.inverse_mass->apply(exec, without_translation(exec, model, p, count), v, count);
    if (parts_.free) parts_.free->put_translation(exec, model, v, count);
  }

  /// The push that kick() found, and the mean acceleration a = (A p - v) / t.
  void push_and_accelerate(const typename B::Exec& exec, const Level<B>& level, double t) const {
    const Vectors<B>& v = level.state.v;
    if (!parts_.free) return parts_.inverse_mass->push_and_accelerate(exec, t, p_, v, a_);
    parts_.inverse_mass->push_and_answer(exec, t, g_, p_, a_);
    parts_.free->accelerate(exec, level.model, v, a_, t);
  }

  /// Momenta as the levels get to see them, in g_ where that differs.
  const Vectors<B>& without_translation(const typename B::Exec& exec, const Model<B>& model, const Vectors<B>& p,
                                        const Count& count) const {
    if (!parts_.free) return p;
    parts_.free->take_translation(exec, model, p, g_, count);
    return g_;
  }

  void kick(const typename B::Exec& exec, const Level<B>& level, double t) {
    parts_.inverse_mass->turn(exec, level.state.u);
    KickMomentum<B> kick{.model = level.model,
                         .f = level.f,
                         .v = level.state.v,
                         .p = p_,
                         .contact = contact_,
                         .rigid = {},
                         .loss = {turned_, parts_.options.dissipation.value_or(-1)},
                         .t = static_cast<Real>(t)};
    if (parts_.free) {
      kick.rigid = parts_.free->rigid_part(exec, level.model, level.state, p_);
      parts_.free->kick(exec, level.model, kick, g_);
    } else {
      update_vertices<B>(exec, "plica::him_momenta", n_, kick);
    }
    parts_.inverse_mass->find_push(exec, parts_.free ? g_ : p_, t);
  }

  /// Contact's forces on the vertices, and A's answer to them.
  void touch(SolverLevel<B>& level, double time, double t) const {
    const auto& exec = level.exec();
    const ContactRecords<B>& records = level.response().records();
    const Doubles<B>& touching = records.touching;
    ScatterContact<B> scatter{.surface = level.surface,
                              .records = records,
                              .f = parts_.contact_force,
                              .model = level.model,
                              .damped = static_cast<Real>(t / 2),
                              .bounding = Bounding::obstacles};  // the first, of unit forces
    const auto respond = [&] {
      where_touching<B>(exec, touching, "plica::contact_zero", n_, ZeroVectors<B>{parts_.contact_force});
      over_list<B>(exec, records.transpose.vertices, "plica::contact_scatter", scatter, touching);
      scatter.bounding = Bounding::none;
      answer(exec, level.model, parts_.contact_force, parts_.contact_answer, touching);
    };
    answer(exec, level.model, parts_.contact_force, parts_.contact_answer, touching);
    where_touching<B>(exec, touching, "plica::contact_expected", n_,
                      TakeExpectedContact<B>{level.model.inverse_mass, parts_.contact_force, parts_.contact_answer, p_,
                                             a_, static_cast<Real>(t)});
    level.response().resolve(exec, level, level.state, time, {.span = t}, a_, parts_.contact_answer, respond);
    level.response().add_impulse(exec, level, level.state, time, t);
  }

  void one(Hierarchy<B>& h, double time, double t) {
    const SolverLevel<B>& level = h[0];
    const auto& exec = h.exec();
    const Scalars<B>& inverse_mass = level.model.inverse_mass;
    const State<B>& x = level.state;
    combine_free<B>(exec, "plica::him_drift", inverse_mass, static_cast<Real>(t / 2), x.v, 1, x.u, x.u);
    prescribe(exec, level, level.state, time + t / 2);
    level.remember(time + t / 2);
    h[0].evaluate_without_contact(level.state, time + t / 2, level.f);
    h.clock.time("turn", 0, [&] { kick(exec, level, t); });
    h.clock.time("answer", 0, [&] { push_and_accelerate(exec, level, t); });
    if (level.contact()) h.clock.time("contact", 0, [&] { touch(h[0], time + t / 2, t); });
    const KickAndDrift<B> finish{.inverse_mass = inverse_mass,
                                 .state = level.state,
                                 .p = p_,
                                 .f = level.f,
                                 .a = a_,
                                 .f_before = f_before_,
                                 .a_before = a_before_,
                                 .contact = contact_,
                                 .contact_answer = parts_.contact_answer,
                                 .t = static_cast<Real>(t)};
    const TurningAxes<B>& axes = parts_.inverse_mass->axes();
    reduce<B, 2>(exec, "plica::him_kick", n_, finish, blocks_, sums_,
                 EndOfStep<B>{{sums_, watch_, axes.last_round(), first_}, axes.angles(), turned_, axes.vertices()});
    prescribe(exec, level, level.state, time + t);
    first_ = false;
  }
};

}  // namespace plica
