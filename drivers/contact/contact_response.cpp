// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/contact/contact_response.hpp>
#include <plica/drivers/contact/pair_search.hpp>
#include <plica/kernels/contact/explicit_contact.hpp>
#include <plica/kernels/contact/implicit_contact.hpp>
#include <plica/kernels/contact/wrenches.hpp>
#include <plica/kernels/halo.hpp>
#include <utility>

namespace plica {

namespace {

// Sweeps after the first one, which finds rho and the forces from e alone. With the inverse of
// lumped masses a sweep costs little, and two bodies that meet fast need these sweeps. With the
// inverse mass of `him` each sweep costs one application of it; where triangles touch, which share
// vertices with each other and with points, fewer sweeps would leave contact too soft.
constexpr int sweeps_of_masses = 7, sweeps_of_him = 3;

/// Returns the whole macro step of which `step` is a part: all its times divided by `part`.
ContactStep of_whole_step(const ContactStep& step, double part) {
  return {step.span / part, step.ahead / part, step.damped / part, step.ends};
}

}  // namespace

template <class B>
ContactResponse<B>::ContactResponse(std::shared_ptr<const Contact<B>> contact,
                                    const LevelData<B>& level, bool implicit)
    : contact_(std::move(contact)),
      own_(contact_->make_records(level.surface, level.model.vertices, implicit)),
      records_(own_),
      maker_(std::max(records_.slots(), level.surface.touched)),
      blocks_(std::max(records_.slots(), records_.points)),
      common_(level.ranks ? BlockSums<B>(records_.slots(), ranks_of<B>(level)) : blocks_),
      sums_of_records_(records_.slots(), ranks_of<B>(level), implicit ? 2 : 0),
      free_(
          zeros<Vectors<B>>("plica::contact.free", static_cast<std::size_t>(level.model.vertices))),
      answer_(zeros<Vectors<B>>("plica::contact.answer",
                                static_cast<std::size_t>(level.model.vertices))),
      sums_(zeros<Doubles<B>>("plica::contact.wrench", 6)),
      impulse_(zeros<Doubles<B>>("plica::contact.impulse",
                                 static_cast<std::size_t>(6 * contact_->wrenches()))),
      carried_impulse_(zeros<Doubles<B>>("plica::contact.carried_impulse",
                                         static_cast<std::size_t>(6 * contact_->wrenches()))),
      work_(zeros<Doubles<B>>("plica::contact.work", 1)) {
  each_array(records_, [](auto& field) { field = lent(field); });
  if (implicit)
    product_ =
        zeros<Vectors<B>>("plica::contact.product", static_cast<std::size_t>(records_.slots()));
  records_.long_steps = implicit;
  if (records_.pairs)
    search_ = std::make_shared<const PairSearch<B>>(contact_->limits(), records_, level.surface);
}

/// Finds and lists the records of a state, and stores that they belong to `time`.
template <class B>
void ContactResponse<B>::find(const Exec& exec, const LevelData<B>& level, const State<B>& state,
                              double time) {
  look(exec, level, state, time);
  found_ = time, fresh_ = false;
}
template <class B>
void ContactResponse<B>::look(const Exec& exec, const LevelData<B>& level, const State<B>& state,
                              double time) const {
  reduce<B, 1, PlacePoints<B>, Sums<1, 1>>(exec, "plica::contact_places", records_.points,
                                           {level.surface, state, records_.places}, blocks_,
                                           records_.fastest);
  contact_->find(exec, level, state, time, records_);
  if (search_) search_->find(exec, level.surface, state, records_, fresh_, blocks_);
  list_contacts<B>(exec, level.surface, records_, maker_);
}

/// Returns the records for use at the level's state, and the time since they were found.
/// Where no step has been taken yet, they are found first.
template <class B>
RecordLater<B> ContactResponse<B>::later(const Exec& exec, const LevelData<B>& level,
                                         double time) const {
  if (fresh_) look(exec, level, level.state, time);
  const double since = fresh_ ? 0 : std::max(0.0, time - found_);
  return {level.surface, level.state.v, records_, static_cast<Real>(since), records_.span};
}

template <class B>
void ContactResponse<B>::solve(const Exec& exec, const LevelData<B>& level, const State<B>& state,
                               double time, const ContactStep& given, ExplicitContact<B> contact,
                               const Respond& respond, const std::function<void()>& free) {
  const ContactStep step = of_whole_step(given, part_);
  records_.span = contact.h = static_cast<Real>(step.span);
  contact.ahead = static_cast<Real>(step.ahead);
  find(exec, level, state, time);
  contact.records = records_;
  free();
  const DeviceList<B>& list = records_.list;
  if (counts_on_all_ && sums_of_records_.ranks())
    sum_records<B, 1>(exec, records_, "plica::contact_start", StartContact<B>{contact},
                      sums_of_records_, records_.touching);
  else
    sum_list<B, 1>(exec, list, "plica::contact_start", StartContact<B>{contact}, blocks_,
                   records_.touching);
  const int sweeps = contact.isotropic || contact_->whole() > 0 ? sweeps_of_masses : sweeps_of_him;
  for (int sweep = 0; sweep <= sweeps; ++sweep) {
    respond();
    over_list<B>(exec, list, "plica::contact_sweep", SweepContact<B>{contact, sweep == 0},
                 records_.touching);
  }
  respond();
  if (given.ends)
    end(exec, "plica::contact_stretch", StretchContact<B>{contact, static_cast<Real>(given.span)});
}

/// Launches the last kernel of a step, and adds the work of friction that it returns to `work_`.
/// Without friction the work is not summed.
template <class B>
template <class End>
void ContactResponse<B>::end(const Exec& exec, const char* label, const End& kernel) const {
  if (!contact_->rubs()) return over_list<B>(exec, records_.list, label, kernel);
  sum_records_later<B, 1>(exec, records_, label, kernel, sums_of_records_, sums_,
                          AddWork<B>{sums_, work_});
}

template <class B>
void ContactResponse<B>::resolve(const Exec& exec, const LevelData<B>& level, const State<B>& state,
                                 double time, const ContactStep& step, const Vectors<B>& free,
                                 const Vectors<B>& answer, const Respond& respond) {
  const bool before = std::exchange(records_.long_steps, true);
  solve(exec, level, state, time, step,
        {level.surface, records_, state.v, free, answer, 0, 0, false}, respond, [] {});
  records_.long_steps = before;
}

template <class B>
void ContactResponse<B>::add_forces(const Exec& exec, const LevelData<B>& level,
                                    const State<B>& state, double time, const ContactStep& given,
                                    const Vectors<B>& f) {
  if (!(given.span > 0)) {
    look(exec, level, state, time);
    over_list<B>(exec, records_.list, "plica::contact_static", StaticContact<B>{records_});
    return scatter(exec, level, f);
  }
  const Real damped = static_cast<Real>(of_whole_step(given, part_).damped);
  AnswerByMass<B> answer{level.surface, level.model, records_,
                         answer_,       damped,      AbsoluteWeights::all};
  const DeviceList<B>& vertices = records_.transpose.vertices;
  solve(
      exec, level, state, time, given,
      {level.surface, records_, state.v, free_, answer_, 0, 0, true},
      [&] {
        over_list<B>(exec, vertices, "plica::contact_answer", answer, records_.touching);
        answer.absolute_weights = AbsoluteWeights::none;
      },
      [&] {
        over_list<B>(exec, vertices, "plica::contact_free",
                     FreeAcceleration<B>{level.surface, records_.transpose, level.model, f, state.v,
                                         free_, damped});
      });
  scatter(exec, level, f);
}

template <class B>
void ContactResponse<B>::forget_impulse(const Exec& exec) const {
  fill(exec, impulse_, 0);
}

template <class B>
void ContactResponse<B>::add_impulse(const Exec& exec, const LevelData<B>& level,
                                     const State<B>& state, double time, double weight) const {
  add_impulse(exec, level, state, time, CarriedImpulse{weight});
}
template <class B>
void ContactResponse<B>::add_impulse(const Exec& exec, const LevelData<B>& level,
                                     const State<B>& state, double time,
                                     const CarriedImpulse& of) const {
  const auto add = [&](int number, const auto& term) {
    sum_records_later<B, 6>(exec, records_, "plica::contact_wrench", term, sums_of_records_, sums_,
                            AddImpulse<B>{sums_, impulse_, carried_impulse_, 6 * number, of});
  };
  for (int o = 0; o < contact_->obstacles(); ++o)
    add(o, ObstacleWrench<B>{level.surface, state.u, records_, o, contact_->place(o, time)});
  for (int b = 0; b < contact_->touching_bodies(); ++b)
    add(contact_->obstacles() + b, BodyWrench<B>{level.surface, state.u, records_, b});
}

template <class B>
double ContactResponse<B>::energy(const Exec& exec, const LevelData<B>& level, double time) const {
  return energy(exec, level, time, !fresh_);
}
template <class B>
double ContactResponse<B>::energy_by_depth(const Exec& exec, const LevelData<B>& level,
                                           double time) const {
  return energy(exec, level, time, false);
}
template <class B>
double ContactResponse<B>::energy(const Exec& exec, const LevelData<B>& level, double time,
                                  bool by_force) const {
  const RecordLater<B> at = later(exec, level, time);
  sum_records<B, 1>(exec, records_, "plica::contact_energy", ContactEnergy<B>{at, by_force},
                    sums_of_records_, sums_);
  return host_values(exec, sums_)[0];
}

template <class B>
double ContactResponse<B>::energy_found(const Exec& exec, const LevelData<B>& level,
                                        const State<B>& state, double time) {
  using Archive = Archive<B>;
  Archive keep(Archive::Task::keep, aside_, exec), put_back(Archive::Task::put_back, aside_, exec);
  name_kept(keep, exec, level);
  find(exec, level, state, time);
  const double found = energy_by_depth(exec, level, time);
  name_kept(put_back, exec, level);
  return found;
}

template <class B>
double ContactResponse<B>::friction_work(const Exec& exec) const {
  return host_values(exec, work_)[0];
}

template <class B>
std::vector<double> ContactResponse<B>::slipping(const Exec& exec) const {
  std::vector<double> all;
  for (int o = 0; o < contact_->obstacles(); ++o) {
    sum_records<B, 2>(exec, records_, "plica::contact_slips", CountSlips<B>{records_, o},
                      sums_of_records_, sums_);
    const auto counts = host_values(exec, sums_);
    all.push_back(counts[0] > 0 ? counts[1] / counts[0] : 0);
  }
  return all;
}

template <class B>
std::vector<double> ContactResponse<B>::normal_forces(const Exec& exec) const {
  exec.fence("plica::normal_forces");
  const auto item = on_host(records_.list.item);
  const auto count = on_host(records_.list.count);
  const auto point = on_host(records_.point);
  const auto weight = on_host(records_.weight);
  const auto force = on_host(records_.force), normal = on_host(records_.normal);
  std::vector<double> all(static_cast<std::size_t>(records_.points), 0.0);
  for (int i = 0; i < static_cast<int>(count(0)); ++i) {
    const int r = item(i);
    double pressing = 0;  // a tie has no normal
    for (int k = 0; k < 3; ++k)
      pressing += static_cast<double>(force(r, k)) * static_cast<double>(normal(r, k));
    for (int c = 0; pressing > 0 && c < 4; ++c)
      if (const int p = point(r, c); p >= 0)
        all[static_cast<std::size_t>(p)] += std::abs(static_cast<double>(weight(r, c))) * pressing;
  }
  return all;
}

template <class B>
std::vector<double> ContactResponse<B>::depths(const Exec& exec, const LevelData<B>& level,
                                               double time) const {
  const RecordLater<B> at = later(exec, level, time);
  std::vector<double> all;
  for (int o = 0; o < contact_->obstacles() + (contact_->has_pairs() ? 1 : 0); ++o) {
    sum_list<B, 1, DepthInPartner<B>, Sums<1, 1>>(exec, records_.list, "plica::contact_depth",
                                                  {at, o}, common_, sums_);
    all.push_back(host_values(exec, sums_)[0]);
  }
  return all;
}

template <class B>
void ContactResponse<B>::begin_stage(const Exec& exec, const LevelData<B>& level,
                                     const State<B>& state, double time,
                                     const ContactStage& stage) {
  stage_ = stage;
  records_.span = static_cast<Real>(stage.span);
  find(exec, level, state, time);
  over_list<B>(exec, records_.list, "plica::contact_begin",
               BeginContact<B>{level.surface, state.u, records_});
  found_ = time + stage.span;
}

template <class B>
ImplicitContact<B> ContactResponse<B>::at(const LevelData<B>& level, const State<B>& state,
                                          double ahead) const {
  return {level.surface,
          state,
          records_,
          static_cast<Real>(stage_.span),
          static_cast<Real>(stage_.scale),
          static_cast<Real>(ahead)};
}

template <class B>
ContactBalance ContactResponse<B>::read_balance(const Exec& exec) const {
  const auto sums = host_values(exec, sums_);
  return {stage_.factor / stage_.scale * sums[0], stage_.factor * sums[1]};
}

template <class B>
ContactBalance ContactResponse<B>::linearise(const Exec& exec, const LevelData<B>& level,
                                             const State<B>& state, const ImplicitWeights& w,
                                             double ahead, const Vectors<B>& f, bool secant) {
  const auto weight = static_cast<Real>(w.a * stage_.factor * stage_.scale);
  sum_long_terms<B, 2>(exec, records_, "plica::contact_linearise",
                       LineariseContact<B>{at(level, state, ahead), weight, true, secant},
                       sums_of_records_, sums_);
  scatter(exec, level, f, stage_.factor);
  return read_balance(exec);
}

template <class B>
ContactBalance ContactResponse<B>::balance(const Exec& exec, const LevelData<B>& level,
                                           const State<B>& state) {
  sum_long_terms<B, 2>(exec, records_, "plica::contact_balance",
                       LineariseContact<B>{at(level, state, 0), 0, false}, sums_of_records_, sums_);
  return read_balance(exec);
}

template <class B>
void ContactResponse<B>::update_caps(const Exec& exec, const LevelData<B>& level,
                                     const State<B>& state) const {
  over_list<B>(exec, records_.list, "plica::contact_caps", UpdateCaps<B>{at(level, state, 0)});
}

template <class B>
void ContactResponse<B>::end_stage(const Exec& exec, const LevelData<B>& level,
                                   const State<B>& state) const {
  end(exec, "plica::contact_end", EndContact<B>{at(level, state, 0)});
}

/// Adds the last forces to the vertices: f += factor W^T F.
template <class B>
void ContactResponse<B>::scatter(const Exec& exec, const LevelData<B>& level, const Vectors<B>& f,
                                 double factor) const {
  over_list<B>(exec, records_.transpose.vertices, "plica::contact_scatter",
               ScatterContact<B>{.surface = level.surface,
                                 .records = records_,
                                 .f = f,
                                 .factor = static_cast<Real>(factor)});
}

template <class B>
void ContactResponse<B>::add_product(const Exec& exec, const LevelData<B>& level,
                                     const Vectors<B>& p, bool beside, const Vectors<B>& q) const {
  if (beside && !contact_->couples()) return;
  over_list<B>(exec, records_.list, "plica::contact_product",
               ContactProduct<B>{level.surface, p, records_, product_, beside});
  ContactRecords<B> products = records_;
  products.force = product_;
  over_list<B>(exec, records_.transpose.vertices, "plica::contact_scatter",
               ScatterContact<B>{.surface = level.surface, .records = products, .f = q});
}

template <class B>
void ContactResponse<B>::add_diagonal(const Exec& exec, const LevelData<B>& level, bool beside,
                                      const Blocks<B>& diagonal) const {
  if (beside && !contact_->couples()) return;
  over_list<B>(exec, records_.transpose.vertices, "plica::contact_diagonal",
               AddContactBlocks<B>{level.surface, records_, beside, diagonal});
}

template <class B>
void ContactResponse<B>::add_matrix(const Exec& exec, const LevelData<B>& level, double scale,
                                    const BlockMatrix<B>& A) const {
  over_list<B>(exec, records_.transpose.vertices, "plica::contact_matrix",
               AddContactToMatrix<B>{level.surface, records_, static_cast<Real>(scale), A});
}

// --- Values that are carried from step to step ---------------------------------------------------

template <class B>
void ContactResponse<B>::reset_history(const Exec& exec) {
  fill(exec, records_.near, 0), fill(exec, records_.list.count, 0.0),
      fill(exec, records_.touching, 0.0);
  fill(exec, records_.transpose.vertices.count, 0.0);
  if (records_.pairs) fill(exec, records_.partner, -1);
  fill(exec, carried_impulse_, 0.0);
  fresh_ = true;
}

template <class B>
void ContactResponse<B>::name_records(Archive<B>& archive, const std::string& name) const {
  const ContactRecords<B>& r = records_;
  const auto of_slots = [&](const char* what, const auto& field) {
    archive.field(name + what, field, RowItems::contacts);
  };
  of_slots("slots in use", r.near);
  archive.field(name + "surface points", r.point, RowItems::points_of_contacts);
  of_slots("laws", r.law_of);
  archive.field(name + "partners", r.partner);
  of_slots("weights", r.weight), of_slots("normals", r.normal), of_slots("depths", r.depth);
  of_slots("ways", r.way), of_slots("stretches", r.stretch), of_slots("forces", r.force);
}

template <class B>
void ContactResponse<B>::name_fields(Archive<B>& archive, const std::string& name, const Exec& exec,
                                     const LevelData<B>& level) {
  archive.number(found_), archive.number(fresh_), archive.number(records_.span);
  name_records(archive, name + "contact: ");
  archive.field(name + "contact: carried impulses", carried_impulse_);
  archive.field(name + "contact: friction's work", work_);
  archive.owns(own_, maker_.used, maker_.summed, blocks_.view(), common_.view(),
               sums_of_records_.integers(), sums_of_records_.terms(), product_, free_, answer_,
               sums_, impulse_);
  if (search_) search_->name_fields(archive);
  if (archive.restoring()) list_contacts<B>(exec, level.surface, records_, maker_);
}

template <class B>
void ContactResponse<B>::name_kept(Archive<B>& archive, const Exec& exec,
                                   const LevelData<B>& level) {
  name_records(archive, {});
  archive.field({}, work_);
  archive.number(found_), archive.number(fresh_);
  if (archive.restoring()) list_contacts<B>(exec, level.surface, records_, maker_);
}

#define PLICA_INSTANTIATE(Real, Exec) template class ContactResponse<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
