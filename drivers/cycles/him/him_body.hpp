// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/cycles/him/free_motion.hpp>
#include <plica/drivers/cycles/him/inertia.hpp>
#include <plica/kernels/halo.hpp>

// Symbols of cmake/docs/explanation/him.md: A is HimParts::inverse_mass, with the translation of
// HimParts::free. u, v are state_, f is f_, p is HimFields::p, F is found in kick(). gamma is
// HimParts::fit.scale.
namespace plica {

/// Data of the stepper `him` for one body.
template <class B>
struct HimParts {
  RowsOfBody rows;  ///< rows of its vertices among those of the level
  std::unique_ptr<InverseMass<B>> inverse_mass;
  std::unique_ptr<InertiaFitter<B>> fitter;
  std::optional<FreeMotion<B>> free;  ///< only for a body that nothing holds
  InertiaFit fit;
  /// Level whose critical step the automatic step is a multiple of: 0, the finest.
  /// It is 1 without coarser meshes where level 1 is a space for slivers.
  std::size_t detail = 0;
  std::vector<std::size_t> places;  ///< [levels] place of each among the reports, finest first
};

/// Fields of the finest level that `him` needs, for all bodies.
template <class B>
struct HimFields {
  Vectors<B> p;                            ///< momenta [kg m/s], 0 where the motion is given
  Vectors<B> g;                            ///< work space: momenta without translation
  Vectors<B> a;                            ///< mean accelerations over the step [m/s^2]
  Vectors<B> force_before, answer_before;  ///< f [N] and a [m/s^2] of the last step
  ContactForces<B> contact;                ///< forces of the last step; empty without contact
  Vectors<B> contact_answer;               ///< accelerations by contact's forces [m/s^2]

  HimFields() = default;
  HimFields(int vertices, bool touches, const Doubles<B>& touching)
      : p("plica::him.p", vertices),
        g("plica::him.g", vertices),
        a("plica::him.a", vertices),
        force_before("plica::him.f_before", vertices),
        answer_before("plica::him.a_before", vertices),
        contact{{}, touching} {
    if (!touches) return;
    contact.force =
        zeros<Vectors<B>>("plica::him.contact_force", static_cast<std::size_t>(vertices));
    contact_answer =
        zeros<Vectors<B>>("plica::him.contact_answer", static_cast<std::size_t>(vertices));
  }

  /// Returns one body's rows of all fields, without a copy.
  HimFields of(const RowsOfBody& rows) const {
    HimFields some;
    some.p = rows.of(p), some.g = rows.of(g), some.a = rows.of(a);
    some.force_before = rows.of(force_before), some.answer_before = rows.of(answer_before);
    some.contact = {rows.of(contact.force), contact.touching},
    some.contact_answer = rows.of(contact_answer);
    return some;
  }
};

/// Part of one body in a step of the hierarchical inverse mass.
/// The inverse mass of several bodies is block diagonal. Each body has coarser levels, frames, a
/// fit and, where nothing holds it, a translation of its own. Its fields are rows of the level's
/// fields.
template <class B>
class HimBody {
  using Real = typename B::Real;
  using Exec = typename B::Exec;

 public:
  HimBody(const LevelData<B>& level, HimParts<B>&& parts, const HimFields<B>& all)
      : parts_(std::move(parts)),
        n_(parts_.rows.count),
        model_(level.model),
        state_(parts_.rows.of(level.state.u), parts_.rows.of(level.state.v)),
        f_(parts_.rows.of(level.f)),
        fields_(all.of(parts_.rows)),
        owned_(level.ranks ? vertices_of<B>(level) : Items(n_)),
        blocks_(n_, ranks_of<B>(level)),
        turned_("plica::him.turned", 1),
        sums_("plica::him.sums", 2),
        watch_("plica::him.watch", 3) {
    model_.mass = parts_.rows.of(model_.mass),
    model_.inverse_mass = parts_.rows.of(model_.inverse_mass);
    model_.damping.of_vertex = parts_.rows.of(model_.damping.of_vertex);
    scale_at(0) = parts_.fit.scale;
  }

  static constexpr int most_halvings = 6;  ///< maximum halvings of a step
  const HimParts<B>& parts() const { return parts_; }
  InertiaFitter<B>& fitter() { return *parts_.fitter; }

  /// Fits the inertia to the state u of all bodies, for a step of `t` [s] after `halvings`.
  /// Returns false where nothing fits.
  bool fit(double t, double sigma, int halvings, const Vectors<B>& u) {
    const auto fit = parts_.fitter->fit(t, sigma, u);
    if (fit) parts_.fit = *fit, scale_at(halvings) = fit->scale;
    return fit.has_value();
  }
  /// Returns true where there was a fit with so many halvings; use_fit() uses the last of these.
  bool has_fit(int halvings) const { return scales_[static_cast<std::size_t>(halvings)] > 0; }
  void use_fit(double t, double sigma, int halvings) {
    parts_.fit = parts_.fitter->use(t, sigma, scale_at(halvings));
  }

  /// Turns the frames with the state u of all bodies.
  void turn(const Exec& exec, const Vectors<B>& u) const {
    parts_.inverse_mass->turn(exec, parts_.rows.of(u));
  }

  /// Sets v = A p in this body's rows. With a `count` on the device, only where that is above 0.
  void answer(const Exec& exec, const Vectors<B>& p, const Vectors<B>& v,
              const Doubles<B>& count = {}) const {
    const Vectors<B> momenta = parts_.rows.of(p), answer = parts_.rows.of(v);
    if (!parts_.free) return parts_.inverse_mass->apply(exec, momenta, answer, count);
    parts_.free->take_translation(exec, model_, momenta, fields_.g, count);
    parts_.inverse_mass->apply(exec, fields_.g, answer, count);
    parts_.free->put_translation(exec, model_, answer, count);
  }

  /// Kicks the momenta by the level's forces over a time t [s], and finds the force F of frames for
  /// the result.
  void kick(const Exec& exec, double dissipation, double t) const {
    parts_.inverse_mass->turn(exec, state_.u);
    KickMomentum<B> kick{.model = model_,
                         .f = f_,
                         .v = state_.v,
                         .p = fields_.p,
                         .contact = fields_.contact,
                         .rigid = {},
                         .loss = {turned_, dissipation},
                         .t = static_cast<Real>(t)};
    if (parts_.free) {
      kick.rigid = parts_.free->rigid_part(exec, model_, state_, fields_.p);
      parts_.free->kick(exec, model_, kick, fields_.g);
    } else {
      update_vertices<B>(exec, "plica::him_momenta", n_, kick);
    }
    parts_.inverse_mass->solve_frame_force(exec, parts_.free ? fields_.g : fields_.p, t);
  }

  /// Adds the force that kick() found, p += t F, and sets mean accelerations a = (A p - v) / t.
  void push_and_accelerate(const Exec& exec, double t) const {
    if (!parts_.free)
      return parts_.inverse_mass->push_and_accelerate(exec, t, fields_.p, state_.v, fields_.a);
    parts_.inverse_mass->push_and_answer(exec, t, fields_.g, fields_.p, fields_.a);
    parts_.free->accelerate(exec, model_, state_.v, fields_.a, t);
  }

  /// Sets the velocities at the end of the step, drifts by half a step, and updates the watch on
  /// stability.
  void finish(const Exec& exec, double t) {
    const KickAndDrift<B> finish{.inverse_mass = model_.inverse_mass,
                                 .state = state_,
                                 .p = fields_.p,
                                 .f = f_,
                                 .a = fields_.a,
                                 .f_before = fields_.force_before,
                                 .a_before = fields_.answer_before,
                                 .contact = fields_.contact,
                                 .contact_answer = fields_.contact_answer,
                                 .t = static_cast<Real>(t)};
    const CoarseFrames<B>& frames = parts_.inverse_mass->frames();
    reduce<B, 2>(exec, "plica::him_kick", owned_, finish, blocks_, sums_,
                 EndOfStep<B>{{sums_, watch_, frames.last_round(), first_},
                              frames.angles(),
                              turned_,
                              frames.vertices()});
    first_ = false;
  }

  /// Forgets what the next step would take from the last, except momenta and contact.
  void reset_history(const Exec& exec) {
    first_ = true;
    fill(exec, watch_, 0.0), fill(exec, turned_, 0.0);
    fill(exec, parts_.inverse_mass->frames().share(), Real(0));
  }

  /// Returns true where steps were unstable: by the spectrum, or F was not found. Waits.
  /// See WatchStability.
  bool lost_stability(const Exec& exec) const {
    exec.fence("plica::him_watch");
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), watch_)(1) > 0;
  }

  void name_fields(Archive<B>& archive) {
    for (double& scale : scales_) archive.number(scale);
    archive.number(first_);
    parts_.inverse_mass->name_fields(archive);
    archive.field("how far they turned", turned_);
    archive.owns(blocks_.view(), sums_, watch_);
    parts_.fitter->name_fields(archive);
    if (parts_.free) parts_.free->name_fields(archive);
  }

 private:
  HimParts<B> parts_;
  int n_;
  VertexModel<B> model_;
  State<B> state_;
  Vectors<B> f_;
  HimFields<B> fields_;
  Items owned_;  ///< vertices, and which of them this process owns
  BlockSums<B> blocks_;
  Doubles<B> turned_, sums_, watch_;
  bool first_ = true;  // no step since the state was set
  // [halvings] gamma of the last fit with so many halvings; 0: none
  std::array<double, most_halvings + 1> scales_ = {};

  double& scale_at(int halvings) { return scales_[static_cast<std::size_t>(halvings)]; }
};

}  // namespace plica
