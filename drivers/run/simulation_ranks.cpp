// SPDX-License-Identifier: BSD-3-Clause
// A simulation that several ranks share.
//
// Set-up is the same on all ranks, of the whole meshes; each keeps its part of each level. Where
// there is contact, each has all of the levels but the finest. Forces are completed by messages
// (kernels/halo.hpp), sums are taken over all ranks (kernels/reduce.hpp), and what is decided by
// sums is decided alike everywhere. So each function that sends a message or changes the state is
// called by all ranks.
//
// A program calls them on every rank, or it lets rank 0 lead: there each call first tells the
// others, which are in follow() and do the same. Files, messages and Ctrl-C are then a matter of
// rank 0 alone.
//
//   rank 0    step_checked() ........... positions() ......... ~Simulation()
//                 | tell(step_checked)       | tell(positions)     | tell(end)
//   rank 1    step_checked() ........... positions() ......... follow() returns
#include <algorithm>
#include <cstring>
#include <numeric>
#include <plica/core/text.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/run/simulation_impl.hpp>
#include <plica/drivers/run/whole.hpp>
#include <span>
#include <stdexcept>
#include <utility>

namespace plica {

namespace {

/// Message from rank 0 to the others.
struct Told {
  Call call = Call::end;
  double argument = 0, other = 0;
};

}  // namespace

/// Finds out which surface points and tetrahedra the ranks have.
template <class B>
void Simulation<B>::Impl::join_numbers() {
  const RankPart& part = hierarchy()[0].ranks->part;
  std::vector<int> points;
  for (const int p : built.owned_points)
    points.push_back(built.surface_point[static_cast<std::size_t>(p)]);
  joined_points = joined(*ranks, points);
  const bool nodal = built.reports.front().element == name_of(Element::nodal);
  for (int i = 0; i < hierarchy().count(); ++i) {
    std::vector<int>& tets = joined_tets.emplace_back();
    const auto& its = hierarchy()[i].ranks;
    const bool has_runs =
        built.reports[static_cast<std::size_t>(i)].element == name_of(Element::linear);
    if (its && has_runs) tets = joined(*ranks, its->part.tet);
  }
  const std::vector<int> work =
      joined(*ranks, std::vector{nodal ? part.owned() : static_cast<int>(part.tet.size())});
  double all = 0;
  for (const int one : work) all += one;
  imbalance = *std::ranges::max_element(work) * static_cast<double>(work.size()) / all;
}

template <class B>
void Simulation<B>::Impl::tell(Call call, double argument, double other) const {
  const Told told{call, argument, other};
  const auto* const bytes = reinterpret_cast<const std::byte*>(&told);
  ranks->to_all(std::vector<Bytes>(static_cast<std::size_t>(ranks->count()),
                                   Bytes(bytes, bytes + sizeof told)));
}

template <class B>
void Simulation<B>::Impl::expect_one_process(const char* what) const {
  if (ranks)
    throw InputError(text(what, " needs a body that one process has all of, and ", ranks->count(),
                          " share this one; expected one process"));
}

template <class B>
int Simulation<B>::Impl::lost_point(const Contact<B>& contact) {
  const int point = contact.take_lost(hierarchy().exec());
  if (!ranks) return point;
  double number = point;
  ranks->most({&number, 1});
  return static_cast<int>(number);
}

/// Calls the caller's function after a step that was repeated. Where rank 0 leads, the others do
/// what it asks for in that function.
template <class B>
void Simulation<B>::Impl::call_after_repeated() {
  const int depth = std::exchange(calls, 0);
  if (follows) {
    follow(Call::go_on);
  } else {
    if (after_repeated) after_repeated();
    if (leads) tell(Call::go_on);
  }
  calls = depth;
}

template <class B>
std::vector<double> Simulation<B>::Impl::given(const std::vector<double>& own, int components,
                                               const std::vector<int>& order) const {
  if (!is_led()) return own;
  const std::vector<double> all = joined(*ranks, own, Receiver::first);
  if (order.empty() || all.empty()) return all;
  const auto width = static_cast<std::size_t>(components);
  std::vector<double> sorted(all.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(i * width), components,
                sorted.begin() + order[i] * components);
  return sorted;
}

template <class B>
std::vector<Point> Simulation<B>::Impl::given(const std::vector<Point>& own,
                                              const std::vector<int>& order) const {
  return is_led() ? points_of_numbers(given(numbers_of(own), 3, order)) : own;
}

template <class B>
std::vector<Point> Simulation<B>::Impl::of_vertices(const std::vector<Point>& local,
                                                    int level) const {
  const auto& part = (*built.hierarchy)[level].ranks;
  return part ? given(part->part.of_owned(local)) : local;
}

template <class B>
std::vector<Point> Simulation<B>::Impl::of_points(const std::vector<Point>& local) const {
  if (!ranks) return local;
  std::vector<Point> own;
  for (const int p : built.owned_points) own.push_back(local[static_cast<std::size_t>(p)]);
  return given(own, joined_points);
}

/// Makes the maker of whole fields for saved states. All ranks call this.
template <class B>
std::unique_ptr<RankFields> Simulation<B>::Impl::shared_fields() {
  if (!ranks) return {};
  std::vector<RankItems> levels;
  for (const Level<B>& level : hierarchy().levels) {
    RankItems& own = levels.emplace_back();
    if (!level.ranks) continue;
    own.part = &level.ranks->part;
    own.element_bytes = fields::bytes_of(level.stress.memory);
    own.slots = static_cast<std::size_t>(level.model.rows.slots());
    if (!level.contact()) continue;  // and then it is level 0
    own.points = built.surface_point, own.owned_points = built.owned_points;
    own.obstacles = static_cast<int>(problem.contact.obstacles.size());
  }
  return std::make_unique<RankFields>(*ranks, std::move(levels));
}

/// Returns the bytes that rank 0 has.
template <class B>
std::vector<unsigned char> Simulation<B>::Impl::bytes_of_first(
    const std::vector<unsigned char>& bytes) const {
  if (!ranks) return bytes;
  const auto own = std::as_bytes(std::span(bytes));
  const std::vector<Bytes> all = ranks->gather(ranks->own() == 0 ? own : own.first(0));
  const auto* const first = reinterpret_cast<const unsigned char*>(all.front().data());
  return {first, first + all.front().size()};
}

template <class B>
std::vector<int> Simulation<B>::numbers() const {
  const LevelData<B>& level = impl_->hierarchy()[0];
  if (level.ranks) return level.ranks->part.of_owned(level.ranks->part.vertex);
  std::vector<int> all(static_cast<std::size_t>(level.model.vertices));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

template <class B>
std::optional<RankReport> Simulation<B>::ranks() const {
  Impl& s = *impl_;
  if (!s.ranks) return {};
  const LedCall led(s, Call::ranks);
  const Traffic own = s.ranks->traffic();
  std::int64_t sums[] = {own.messages, own.bytes};
  s.ranks->sum(sums);
  const std::vector<double> waited = joined(*s.ranks, std::vector{own.waited});
  RankReport report{s.ranks->count(), s.imbalance, sums[0], sums[1]};
  for (const double one : waited)
    report.waited += one / report.count, report.most_waited = std::max(report.most_waited, one);
  return report;
}

template <class B>
void Simulation<B>::lead() {
  impl_->leads = impl_->ranks != nullptr;
}

template <class B>
void Simulation<B>::dismiss(int status) {
  if (std::exchange(impl_->leads, false)) impl_->tell(Call::end, status);
}

template <class B>
int Simulation<B>::follow() {
  Impl& s = *impl_;
  s.follows = true;
  on_repeated_step({});
  s.self = this;
  const double status = s.follow(Call::end);
  s.follows = false;
  return static_cast<int>(status);
}

/// Does what rank 0 calls until a call, whose argument it returns.
template <class B>
double Simulation<B>::Impl::follow(Call until) {
  const std::vector<Bytes> nothing(static_cast<std::size_t>(ranks->count()));
  for (;;) {
    const std::vector<Bytes> received = ranks->to_all(nothing);
    Told told;
    std::memcpy(&told, received.front().data(), sizeof told);
    if (told.call == until) return told.argument;
    if (told.call == Call::end) throw std::runtime_error("rank 0 has left within a macro step");
    Simulation& s = *self;
    switch (told.call) {
      case Call::step:
        s.step();
        break;
      case Call::step_checked:
        s.step_checked();
        break;
      case Call::check:
        s.check();
        break;
      case Call::recover: {
        Diagnosis bad;
        bad.kind = diagnosis_kinds()[static_cast<std::size_t>(told.argument)].name;
        s.recover(bad);
        break;
      }
      case Call::return_to_last_good:
        s.return_to_last_good();
        break;
      case Call::return_to_step_start:
        s.return_to_step_start();
        break;
      case Call::keep_step_starts:
        s.keep_step_starts(told.argument > 0);
        break;
      case Call::end_at:
        s.end_at(told.argument);
        break;
      case Call::energies:
        s.energies();
        break;
      case Call::reactions:
        s.reactions();
        break;
      case Call::contact_depths:
        s.contact_depths();
        break;
      case Call::slipping:
        s.slipping();
        break;
      case Call::contact_pressure:
        s.contact_pressure();
        break;
      case Call::positions:
        s.positions(static_cast<int>(told.argument));
        break;
      case Call::velocities:
        s.velocities(static_cast<int>(told.argument));
        break;
      case Call::surface_positions:
        s.surface_positions();
        break;
      case Call::surface_velocities:
        s.surface_velocities();
        break;
      case Call::element_fields:
        s.element_fields(static_cast<int>(told.argument), told.other > 0);
        break;
      case Call::ranks:
        s.ranks();
        break;
      case Call::save:
        s.save();
        break;
      case Call::restore:
        try {
          s.restore({});
        } catch (const ThrownByAll&) {  // rank 0 throws it too: its caller decides what to do
        }
        break;
      case Call::go_on:
      case Call::end:
        break;
    }
  }
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
