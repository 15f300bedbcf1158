// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/cycles/him/find_momenta.hpp>
#include <plica/drivers/cycles/him/him_parts.hpp>
#include <plica/drivers/cycles/him/him_stepper.hpp>
#include <plica/drivers/elastic/largest_eigenvalue.hpp>

namespace plica {

namespace {

/// Returns the largest t^2 lambda_max(A K) at which a longer step is taken again.
/// It is half way from the value at rest, 4 sigma^2, to 3.4, above which WatchStability reports it.
double steady_product(double sigma) { return (4 * sigma * sigma + 3.4) / 2; }

constexpr double explicit_safety = 0.9;  // explicit step over the largest stable one
// Cost of a step of the inverse mass, over that of an explicit step of level 0:
// cmake/docs/explanation/him.md
constexpr double cost_of_step = 3, cost_with_contact = 6;
constexpr int most_explicit = 1 << 14;  // maximum sub-steps, over those of level 0 at rest

}  // namespace

// --- Set-up --------------------------------------------------------------------------------------

template <class B>
void HimStepper<B>::plan(StepperSetup<B>& setup) {
  options_ = setup.problem.integration.him;
  may_repair_ = setup.problem.integration.on_failure.halvings == FailureOptions::automatic;
  explicit_limit_ = setup.reports.front().critical_step, eigenvalue_ = setup.eigenvalue;
  std::vector<HimParts<B>> bodies = him_parts<B>(setup);
  double usual = 0;
  bool fits = true;
  if (setup.goes_on && may_repair_ && setup.problem.integration.macro_step) {
    setup.macro_step = *setup.problem.integration.macro_step;
    fits = fit_given_step<B>(setup, bodies);
  } else {
    setup.macro_step = fit_step<B>(setup, bodies, usual);
  }
  report_fits<B>(setup, bodies);
  setup.him->usual_step = usual;
  take(setup.hierarchy, std::move(bodies), setup.contact != nullptr);
  if (!fits) regaining_.cut(), shorten(setup.hierarchy);
}

template <class B>
void HimStepper<B>::take(const Hierarchy<B>& h, std::vector<HimParts<B>>&& parts, bool contact) {
  n_ = h[0].model.vertices, shared_ = h[0].ranks != nullptr;
  macro_step_ = parts.front().fit.step;
  fields_ = HimFields<B>(n_, contact, h[0].response().records().touching);
  for (HimParts<B>& one : parts) bodies_.emplace_back(h[0], std::move(one), fields_);
}

template <class B>
void HimStepper<B>::start(Hierarchy<B>& h) {
  const LevelData<B>& level = h[0];
  const auto& exec = h.exec();
  h[0].response().count_on_all_ranks();
  for (const HimBody<B>& body : bodies_) body.turn(exec, level.state.u);
  weigh<B>(exec, "plica::him_momenta", level.model, 1, level.state.v, 0, level.state.v, fields_.p);
  answer(exec, fields_.p, fields_.a);
  combine_free<B>(exec, "plica::him_start", level.model.inverse_mass, 1, fields_.a, 0, fields_.a,
                  level.state.v);
  reset_history(exec);
}

template <class B>
void HimStepper<B>::begin(Hierarchy<B>& h) {
  const LevelData<B>& level = h[0];
  const auto& exec = h.exec();
  copy(exec, fields_.a, level.state.u);
  const auto half = static_cast<Real>(0.5 * macro_step_ / (1 << halvings_));
  combine_free<B>(exec, "plica::him_back", level.model.inverse_mass, -half, level.state.v, 1,
                  fields_.a, fields_.a);
  for (const HimBody<B>& body : bodies_) body.turn(exec, fields_.a);
  has_momenta_ = false;
  reset_history(exec);
}

template <class B>
void HimStepper<B>::reset_history(const Exec& exec) {
  for (HimBody<B>& body : bodies_) body.reset_history(exec);
  // After steps that went wrong these fields may have values that are not finite.
  fill(exec, fields_.force_before, Real(0));
  fill(exec, fields_.answer_before, Real(0));
  fill(exec, fields_.contact.force, Real(0));
}

// --- Step ----------------------------------------------------------------------------------------

template <class B>
void HimStepper<B>::step(Hierarchy<B>& h, double time, double t) {
  if (explicit_ > 0) return step_explicitly(h, time, t);
  if (!has_momenta_) find_momenta(h.exec(), h[0]);
  for (int s = 0; s < parts(); ++s) substep(h, time + s * t / parts(), t / parts());
}

template <class B>
void HimStepper<B>::step_explicitly(Hierarchy<B>& h, double time, double t) {
  Level<B>& level = h[0];
  // macro steps that are taken again are not counted twice
  if (time + t > explicit_until_) ++explicit_steps_, explicit_until_ = time + t;
  level.timed("integrate", [&] {
    prescribe(h.exec(), level, level.state, time);
    level.integrator->advance(level, time, t / explicit_, explicit_);
  });
}

template <class B>
void HimStepper<B>::find_momenta(const Exec& exec, const LevelData<B>& level) {
  const auto A = [&](const Vectors<B>& p, const Vectors<B>& v) { answer(exec, p, v); };
  momentum_of<B>(exec, level, A, level.state.v, fields_.p);
  has_momenta_ = true;
}

template <class B>
void HimStepper<B>::substep(Hierarchy<B>& h, double time, double t) {
  Level<B>& level = h[0];
  const auto& exec = level.exec();
  const State<B>& x = level.state;
  combine_free<B>(exec, "plica::him_drift", level.model.inverse_mass, static_cast<Real>(t / 2), x.v,
                  1, x.u, x.u);
  prescribe(exec, level, level.state, time + t / 2);
  level.accept_state(time + t / 2);
  level.evaluate_without_contact(level.state, time + t / 2, level.f);
  h.clock.time("turn", 0, [&] {
    for (const HimBody<B>& body : bodies_) body.kick(exec, options_.dissipation.value_or(-1), t);
  });
  h.clock.time("answer", 0, [&] {
    for (const HimBody<B>& body : bodies_) body.push_and_accelerate(exec, t);
  });
  if (level.contact()) h.clock.time("contact", 0, [&] { touch(level, time + t / 2, t); });
  for (HimBody<B>& body : bodies_) body.finish(exec, t);
  prescribe(exec, level, level.state, time + t);
}

template <class B>
void HimStepper<B>::touch(Level<B>& level, double time, double t) const {
  const auto& exec = level.exec();
  const ContactRecords<B>& records = level.response().records();
  const Doubles<B>& touching = records.touching;
  const Vectors<B>&force = fields_.contact.force, &acceleration = fields_.contact_answer;
  ScatterContact<B> scatter{
      .surface = level.surface,
      .records = records,
      .f = force,
      .model = level.model,
      .damped = static_cast<Real>(t / 2),
      .absolute_weights = AbsoluteWeights::obstacles};  // first call: unit forces
  const auto respond = [&] {
    where_touching<B>(exec, touching, "plica::contact_zero", n_, ZeroVectors<B>{force});
    over_list<B>(exec, records.transpose.vertices, "plica::contact_scatter", scatter, touching);
    scatter.absolute_weights = AbsoluteWeights::none;
    answer(exec, force, acceleration, touching);
  };
  answer(exec, force, acceleration, touching);
  where_touching<B>(exec, touching, "plica::contact_expected", n_,
                    TakeExpectedContact<B>{level.model.inverse_mass, force, acceleration, fields_.p,
                                           fields_.a, static_cast<Real>(t)});
  level.response().resolve(exec, level, level.state, time, {.span = t}, fields_.a, acceleration,
                           respond);
  level.response().add_impulse(exec, level, level.state, time, t);
}

// --- Shorter steps, and longer ones again --------------------------------------------------------

template <class B>
bool HimStepper<B>::lost_stability(const Hierarchy<B>& h, double) {
  if (explicit_ == 0)
    return std::ranges::any_of(
        bodies_, [&](const HimBody<B>& body) { return body.lost_stability(h.exec()); });
  const Level<B>& level = h[0];
  const double most = 2 * explicit_ / macro_step_;  // angular frequency [1/s]
  return excited_eigenvalue<B>(h.exec(), {level, level.elasticity(), level.state.u},
                               level.state.v) > most * most;
}

template <class B>
double HimStepper<B>::explicit_step(const Hierarchy<B>& h) const {
  const Level<B>& level = h[0];
  const double now = largest_eigenvalue<B>(h.exec(), {level, level.elasticity(), level.state.u});
  const double stiffened = now > eigenvalue_ ? std::sqrt(eigenvalue_ / now) : 1;
  return explicit_safety * stiffened * explicit_limit_;
}

template <class B>
int HimStepper<B>::most_halvings(double explicit_step) const {
  const double cost = fields_.contact.force.extent(0) > 0 ? cost_with_contact : cost_of_step;
  const double most = std::floor(std::log2(macro_step_ / (cost * explicit_step)));
  return static_cast<int>(std::clamp(most, 0.0, 1.0 * HimBody<B>::most_halvings));
}

template <class B>
bool HimStepper<B>::fit(const Hierarchy<B>& h, int halvings) {
  return std::ranges::all_of(bodies_, [&](HimBody<B>& body) {
    return body.fit(macro_step_ / (1 << halvings), options_.sigma, halvings, h[0].state.u);
  });
}

template <class B>
void HimStepper<B>::use_fits() {
  for (HimBody<B>& body : bodies_)
    body.use_fit(macro_step_ / (1 << halvings_), options_.sigma, halvings_);
}

template <class B>
bool HimStepper<B>::repair(Hierarchy<B>& h, double /*t*/) {
  ++repairs_;
  regaining_.cut();
  if (explicit_ > 0) {
    if (explicit_ > most_explicit / 2 * macro_step_ / (explicit_safety * explicit_limit_))
      return false;
    explicit_ *= 2;
    return true;
  }
  shorten(h);
  if (explicit_ == 0) begin(h);
  return true;
}

template <class B>
void HimStepper<B>::shorten(const Hierarchy<B>& h) {
  const double step = explicit_step(h);
  for (int next = halvings_ + 1; next <= most_halvings(step); ++next)
    if (fit(h, next)) {
      halvings_ = next;
      return;
    }
  use_fits();
  explicit_ = static_cast<int>(
      std::clamp(std::ceil(macro_step_ / step), 1.0,
                 std::ceil(most_explicit * macro_step_ / (explicit_safety * explicit_limit_))));
}

template <class B>
void HimStepper<B>::regrow(Hierarchy<B>& h, double t, long steps) {
  if ((halvings_ == 0 && explicit_ == 0) || !regaining_.due(steps)) return;
  const double sigma = options_.sigma, step = explicit_ > 0 ? explicit_step(h) : 0;
  // number of halvings from which on fewer halvings are tried
  const int longest = explicit_ > 0 ? most_halvings(step) + 1 : halvings_;
  int fitting = longest;
  for (int next = longest - 1; next >= 0; --next) {
    const auto had = [&](const HimBody<B>& body) { return body.has_fit(next); };
    if (!std::ranges::all_of(bodies_, had)) continue;
    const double part = t / (1 << next);
    const auto holds = [&](HimBody<B>& body) {
      body.use_fit(part, sigma, next);
      return body.fitter().product(part, h[0].state.u) <= steady_product(sigma);
    };
    if (!std::ranges::all_of(bodies_, holds)) break;
    fitting = next;
  }
  const bool longer = fitting < longest;
  regaining_.tried(steps, longer);
  const bool returns = longer && explicit_ > 0;
  if (longer) halvings_ = fitting, explicit_ = 0;
  use_fits();
  if (returns) {
    // Removes the fast detail that explicit steps have left. With its added inertia this detail
    // would have more energy.
    start(h);
    has_momenta_ = true;
  } else if (longer) {
    begin(h);
  }
}

template <class B>
void HimStepper<B>::name_fields(Archive<B>& archive) {
  archive.number(halvings_), archive.number(explicit_), archive.number(repairs_),
      archive.number(explicit_steps_);
  archive.number(explicit_until_), archive.number(has_momenta_);
  regaining_.name_fields(archive);
  for (HimBody<B>& body : bodies_) body.name_fields(archive);
  if (archive.restoring()) use_fits();
  archive.field("the momenta", fields_.p, RowItems::vertices);
  archive.field("the last force", fields_.force_before, RowItems::vertices);
  archive.field("the last answer", fields_.answer_before, RowItems::vertices);
  archive.field("the last contact", fields_.contact.force, RowItems::vertices);
  archive.field("how much touched", fields_.contact.touching);
  archive.owns(fields_.g, fields_.a, fields_.contact_answer);
}

template <class B>
std::unique_ptr<Stepper<B>> Him::make() {
  return std::make_unique<HimStepper<B>>();
}

#define PLICA_INSTANTIATE(Real, Exec)             \
  template class HimStepper<Backend<Real, Exec>>; \
  template std::unique_ptr<Stepper<Backend<Real, Exec>>> Him::make<Backend<Real, Exec>>();
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
