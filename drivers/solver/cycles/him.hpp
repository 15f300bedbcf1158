// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/cycles/cycle.hpp>
#include <plica/drivers/solver/him/contact_response.hpp>
#include <plica/drivers/solver/him/inertia.hpp>
#include <plica/drivers/solver/him/rigid_part.hpp>
#include <plica/kernels/him/leapfrog.hpp>

namespace plica {

/// What a cycle `him` is made of.
template <class B>
struct HimParts {
  HimOptions options;
  double mass_damping = 0;  ///< of the body [1/s]
  std::unique_ptr<InverseMass<B>> inverse_mass;
  std::unique_ptr<InertiaFitter<B>> fitter;
  std::optional<RigidPart<B>> rigid;            ///< of a body that nothing holds
  std::unique_ptr<ContactResponse<B>> contact;  ///< of a body with obstacles
  InertiaFit fit;
};

/// The hierarchical inverse mass: one V-cycle and one force evaluation, of the finest level, per macro step. Forces go down to
/// the coarser levels, each answers them with the inertia of what it can move, and their accelerations come back up: motion
/// that coarse levels represent keeps its own inertia, finer detail gets more of it, and so is slowed and allows the step.
/// Static equilibrium is the finest mesh's. Second order where the axes of the coarsest level do not turn. See cmake/docs/him.md.
///
/// A step that leaves the state at t_n and t_n+1 takes forces half way (position Verlet). Where the body has stiffened so far
/// that stability is lost, alarmed() tells; repair() fits the inertia to the state as it is.
template <class B>
class HimCycle final : public Cycle<B> {
  using Real = typename B::Real;

 public:
  HimCycle(Hierarchy<B>& h, HimParts<B>&& parts)
      : parts_(std::move(parts)),
        n_(h[0].level.model.vertices),
        g_("plica::him.g", n_),
        a_("plica::him.a", n_),
        f_before_("plica::him.f_before", n_),
        a_before_("plica::him.a_before", n_),
        blocks_(n_),
        moved_("plica::him.moved", 2),
        loss_("plica::him.loss", 1),
        sums_("plica::him.sums", 2),
        watch_("plica::him.watch", 3) {}

  void start(Hierarchy<B>& h) override {
    const Level<B>& level = h[0].level;
    const auto& exec = h.exec();
    Kokkos::deep_copy(exec, loss_, 1.0);
    Kokkos::deep_copy(exec, g_, Real(0));
    update_vertices<B>(exec, "plica::him_momenta", n_, AddLoss<B>{level.model, g_, level.state.v, g_, loss_, 1, 0});
    h.clock.time("answer", 0, [&] { answer(exec, level, g_, a_); });
    update_vertices<B>(exec, "plica::him_start", n_, StartVelocity<B>{level.model.inverse_mass, a_, level.state.v});
    begin(h);
  }

  void begin(Hierarchy<B>& h) override {
    first_ = true;
    Kokkos::deep_copy(h.exec(), watch_, 0.0);
  }

  void step(Hierarchy<B>& h, double time, double t) override {
    for (int s = 0; s < substeps_; ++s) one(h, time + s * t / substeps_, t / substeps_);
  }

  bool alarmed(const Hierarchy<B>& h) const override {
    h.exec().fence("plica::him_watch");
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), watch_)(1) > 0;
  }

  bool repair(Hierarchy<B>& h, double t, int attempt) override {
    constexpr int most_substeps = 64, attempts_at_a_step = 2;
    if (attempt >= attempts_at_a_step) substeps_ *= 2;
    const Vectors<B>& u = h[0].level.state.u;
    parts_.inverse_mass->turn(h.exec(), u, moved_);
    double scale = 0.5 * parts_.fit.scale;
    for (++repairs_; substeps_ <= most_substeps; substeps_ *= 2, scale = 1)
      if (const auto fit = parts_.fitter->fit(t / substeps_, parts_.options.sigma, u, scale)) {
        parts_.fit = *fit;
        begin(h);
        return true;
      }
    return false;
  }

  std::map<std::string, long> counters() const override {
    return {{"inertia_refits", repairs_}, {"him_substeps", substeps_}};
  }

  std::size_t bytes() const override {
    return parts_.inverse_mass->bytes() + 4 * g_.span() * sizeof(Real) + (parts_.rigid ? g_.span() * sizeof(Real) : 0) +
           (parts_.contact ? parts_.contact->bytes() : 0);
  }

  void persist(StateArchive<B>& archive) override {
    archive.same("the fit of its inertia", parts_.fit.scale);
    archive.number(first_);
    archive.field("the last force", f_before_);
    archive.field("the last answer", a_before_);
    archive.field("the coarsest axes", parts_.inverse_mass->filter().rotation);
  }

 private:
  HimParts<B> parts_;
  int n_;
  Vectors<B> g_, a_, f_before_, a_before_;
  BlockSums<B> blocks_;
  Kokkos::View<double*, typename B::Memory> moved_, loss_, sums_, watch_;
  bool first_ = true;
  int substeps_ = 1;
  long repairs_ = 0;

  using Count = typename InverseMass<B>::Count;

  /// a = A g, changing g; with a count only where that is above 0.
  void answer(const typename B::Exec& exec, const Level<B>& level, const Vectors<B>& g, const Vectors<B>& a,
              const Count& count = {}) const {
    if (parts_.rigid) parts_.rigid->take(exec, level.model, level.state.u, g);
    parts_.inverse_mass->apply(exec, g, a, count);
    if (parts_.rigid) parts_.rigid->put(exec, level.model, level.state.u, a);
  }

  void one(Hierarchy<B>& h, double time, double t) {
    const Level<B>& level = h[0].level;
    const auto& exec = h.exec();
    const Scalars<B>& inverse_mass = level.model.inverse_mass;
    update_vertices<B>(exec, "plica::him_drift", n_, Drift<B>{inverse_mass, level.state, static_cast<Real>(t / 2)});
    prescribe(exec, level, level.state, time + t / 2);
    h[0].forces->evaluate_without_contact(level, level.state, time + t / 2, level.f);
    h.clock.time("turn", 0, [&] { parts_.inverse_mass->turn(exec, level.state.u, moved_); });
    update_vertices<B>(exec, "plica::him_loss", 1,
                       ChooseLoss<B>{moved_, loss_, parts_.options.dissipation.value_or(-1)});
    update_vertices<B>(exec, "plica::him_add_loss", n_,
                       AddLoss<B>{level.model, level.f, level.state.v, g_, loss_, static_cast<Real>(1 / t),
                                  static_cast<Real>(parts_.mass_damping)});
    h.clock.time("answer", 0, [&] { answer(exec, level, g_, a_); });
    if (parts_.contact)
      h.clock.time("contact", 0, [&] {
        parts_.contact->resolve(exec, level, time + t / 2, t, a_, [&](const auto& f, const auto& a, const auto& count) {
          answer(exec, level, f, a, count);
        });
      });
    const KickAndDrift<B> kick{.inverse_mass = inverse_mass,
                               .state = level.state,
                               .f = level.f,
                               .a = a_,
                               .f_before = f_before_,
                               .a_before = a_before_,
                               .contact = parts_.contact ? parts_.contact->answer() : Vectors<B>{},
                               .touching = parts_.contact ? parts_.contact->count() : Count{},
                               .loss = loss_,
                               .t = static_cast<Real>(t)};
    reduce<B, 2>(exec, "plica::him_kick", n_, kick, blocks_, sums_);
    update_vertices<B>(exec, "plica::him_watch", 1, WatchSpectrum<B>{sums_, watch_, first_});
    prescribe(exec, level, level.state, time + t);
    first_ = false;
  }
};

}  // namespace plica
