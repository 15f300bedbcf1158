// SPDX-License-Identifier: BSD-3-Clause
// Queries of a simulation; and saving and restoring what it carries from one macro step to the
// next.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <plica/core/archive.hpp>
#include <plica/core/text.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/loads/exchange.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/run/move_obstacles.hpp>
#include <plica/drivers/run/simulation_impl.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/kernels/halo.hpp>

namespace plica {

template <class B>
const Level<B>& Simulation<B>::Impl::level(int i) {
  if (const int last = hierarchy().count() - 1; i < 0 || i > last)
    throw InputError("level " + std::to_string(i) +
                     " has no state of its own: the cycle integrates " +
                     (last > 0 ? "levels 0 to " + std::to_string(last) : "level 0") + " alone");
  return hierarchy()[i];
}

template <class B>
const Vectors<B>& Simulation<B>::Impl::rest_positions(int i) {
  level(i);  // throws where there is no such level
  Vectors<B>& x = rest[static_cast<std::size_t>(i)];
  if (x.extent(0) == 0) {
    std::vector<Point> at = built.meshes[static_cast<std::size_t>(i)].vertices;
    if (const auto& part = hierarchy()[i].ranks) at = part->part.local(at);
    x = to_device<Vectors<B>>("rest", rows<typename B::Real>(at));
  }
  return x;
}

template <class B>
double Simulation<B>::time() const {
  return impl_->time;
}
template <class B>
double Simulation<B>::macro_step() const {
  return impl_->built.macro_step;
}
template <class B>
long Simulation<B>::macro_steps() const {
  return impl_->steps;
}
template <class B>
const std::vector<LevelReport>& Simulation<B>::levels() const {
  return impl_->built.reports;
}
template <class B>
std::optional<HimReport> Simulation<B>::him() const {
  return impl_->built.him;
}
template <class B>
std::vector<Part> Simulation<B>::parts() const {
  return list_parts<B>(impl_->problem, impl_->built);
}
template <class B>
Energies Simulation<B>::energies() const {
  const LedCall led(*impl_, Call::energies);
  return impl_->meter.all(impl_->time);
}

template <class B>
Doubles<B> Simulation<B>::wrench() const {
  return impl_->wrench;
}
template <class B>
std::vector<ToolState> Simulation<B>::tools() const {
  const auto& obstacles = impl_->problem.contact.obstacles;
  if (std::ranges::none_of(obstacles, [](const ObstacleOptions& o) { return o.mass.has_value(); }))
    return {};
  const std::vector<double> all = host_values(impl_->hierarchy().exec(), impl_->memory);
  std::vector<ToolState> tools;
  for (std::size_t o = 0; o < obstacles.size(); ++o) {
    if (!obstacles[o].mass) continue;
    using Place = ObstacleMotion<B>;
    const double* const own = all.data() + o * Place::numbers;
    ToolState tool{obstacle_name(impl_->problem.contact, o), Point(own), Point(own + 3),
                   !obstacles[o].inertia.empty()};
    if (tool.turns) {
      const double* const q = own + Place::attitude;
      tool.rotation = rotation_vector(Quaternion{q[0], q[1], q[2], q[3]}.rotation());
      tool.angular_velocity = Point(own + Place::rate);
    }
    tools.push_back(tool);
  }
  return tools;
}

template <class B>
std::vector<CavityState> Simulation<B>::cavities() const {
  return impl_->hierarchy()[0].cavities(impl_->time);
}

template <class B>
std::vector<Reaction> Simulation<B>::reactions() const {
  const LedCall led(*impl_, Call::reactions);
  return impl_->held.at(impl_->hierarchy()[0], impl_->rest_positions(0), impl_->time,
                        !seeks_rest(impl_->problem.integration));
}

template <class B>
void Simulation<B>::set_external_forces(const ExternalForces<B>& forces) {
  Impl& s = *impl_;
  if (forces) s.expect_one_process("set_external_forces");
  for (int i = 0; i < s.hierarchy().count(); ++i)
    s.hierarchy()[i].set_external(forces, s.rest_positions(i));
  if (forces) s.budget_known = false;
  s.external = forces;
}

template <class B>
void Simulation<B>::use_graphs(bool on) {
  impl_->graphs = on;
}

template <class B>
void Simulation<B>::share_cores() {
  if (!impl_->cores && !impl_->ranks) impl_->cores.emplace(impl_->hierarchy().exec());
}

template <class B>
void Simulation<B>::time_stages(bool on) {
  impl_->hierarchy().clock.on = on;
}

template <class B>
std::map<std::string, double> Simulation<B>::stages() const {
  return impl_->hierarchy().clock.seconds();
}

template <class B>
std::map<std::string, long> Simulation<B>::counters() const {
  std::map<std::string, long> all = impl_->built.stepper->counters();
  for (int i = 0; i < impl_->hierarchy().count(); ++i) {
    const Level<B>& level = impl_->hierarchy()[i];
    all["force_evaluations"] += level.evaluations();
    long passes = level.evaluations();  // passes over the elements
    for (const auto& [name, count] : level.integrator->counters()) {
      all[name] += count;
      if (name == "cg_iterations") passes += count;
    }
    all["tet_evaluations"] += passes * impl_->built.reports[static_cast<std::size_t>(i)].tets;
  }
  if (gathers<Exec>)
    all["launches_in_graphs"] = impl_->queue.in_graphs(),
    all["launches_alone"] = impl_->queue.alone();
  const Impl& s = *impl_;
  if (s.control.halves())
    all["step_halvings"] = s.control.halvings(), all["rejected_steps"] = s.rejected;
  if (all.contains("newton_iterations")) all["newton_misses"] = s.unsolved;
  return all;
}

template <class B>
double Simulation<B>::residual() const {
  return impl_->residual;
}
template <class B>
double Simulation<B>::worst_residual() const {
  return impl_->worst_residual;
}

template <class B>
Vectors<B> Simulation<B>::displacement(int level) const {
  return impl_->level(level).state.u;
}
template <class B>
Vectors<B> Simulation<B>::velocity(int level) const {
  return impl_->level(level).state.v;
}

template <class B>
void Simulation<B>::read_positions(const DeviceOutput<B>& to, int level) const {
  plica::read_positions<B>(impl_->hierarchy().exec(), impl_->rest_positions(level),
                           displacement(level), to);
}
template <class B>
void Simulation<B>::read_velocities(const DeviceOutput<B>& to, int level) const {
  read_vectors<B>(impl_->hierarchy().exec(), velocity(level), to);
}
template <class B>
void Simulation<B>::read_surface_positions(const DeviceOutput<B>& to) const {
  const LevelData<B>& finest = impl_->level(0);
  read_surface<B>(impl_->hierarchy().exec(), finest.surface, finest.state, false, to);
}
template <class B>
void Simulation<B>::read_surface_velocities(const DeviceOutput<B>& to) const {
  const LevelData<B>& finest = impl_->level(0);
  read_surface<B>(impl_->hierarchy().exec(), finest.surface, finest.state, true, to);
}

template <class B>
void Simulation<B>::read_surface_normals(const DeviceOutput<B>& to) const {
  Impl& s = *impl_;
  const LevelData<B>& finest = s.level(0);
  if (!s.fans) {
    s.fans = build_fans<B>(s.problem.body.surface.value_or(TriangleSurface{}));
    s.surface_x = Vectors<B>("plica::surface.x", finest.surface.points);
  }
  read_surface<B>(s.hierarchy().exec(), finest.surface, finest.state, false, s.surface_x);
  read_normals<B>(s.hierarchy().exec(), *s.fans, s.surface_x, to);
}

template <class B>
void Simulation<B>::write_state(const DeviceInput<B>& positions, const DeviceInput<B>& velocities) {
  impl_->expect_one_process("write_state");
  const State<B>& state = impl_->level(0).state;
  if (velocities.size() != positions.size())  // before anything is written
    throw InputError(std::to_string(positions.size()) + " positions and " +
                     std::to_string(velocities.size()) + " velocities");
  impl_->accept_state();
  write_positions<B>(impl_->hierarchy().exec(), positions, impl_->rest_positions(0), state.u);
  write_vectors<B>(impl_->hierarchy().exec(), velocities, state.v);
  impl_->restart();
}

template <class B>
std::vector<Point> Simulation<B>::positions(int level) const {
  impl_->level(level);  // throws where there is no such level
  const LedCall led(*impl_, Call::positions, level);
  std::vector<Point> x = to_host<B>(impl_->hierarchy().exec(), displacement(level));
  const auto& rest = impl_->built.meshes[static_cast<std::size_t>(level)].vertices;
  const auto& part = impl_->hierarchy()[level].ranks;
  for (std::size_t a = 0; a < x.size(); ++a)
    x[a] += rest[part ? static_cast<std::size_t>(part->part.vertex[a]) : a];
  return impl_->of_vertices(x, level);
}
template <class B>
std::vector<Point> Simulation<B>::velocities(int level) const {
  impl_->level(level);
  const LedCall led(*impl_, Call::velocities, level);
  return impl_->of_vertices(to_host<B>(impl_->hierarchy().exec(), velocity(level)), level);
}
template <class B>
std::vector<Point> Simulation<B>::surface_positions() const {
  const LedCall led(*impl_, Call::surface_positions);
  const Vectors<B> x("plica::surface.x", impl_->level(0).surface.points);
  read_surface_positions(x);
  return impl_->of_points(to_host<B>(impl_->hierarchy().exec(), x));
}
template <class B>
std::vector<Point> Simulation<B>::surface_velocities() const {
  const LedCall led(*impl_, Call::surface_velocities);
  const Vectors<B> v("plica::surface.v", impl_->level(0).surface.points);
  read_surface_velocities(v);
  return impl_->of_points(to_host<B>(impl_->hierarchy().exec(), v));
}
template <class B>
std::vector<Point> Simulation<B>::surface_normals() const {
  impl_->expect_one_process("surface_normals");
  const Vectors<B> n("plica::surface.n", impl_->level(0).surface.points);
  read_surface_normals(n);
  return to_host<B>(impl_->hierarchy().exec(), n);
}

namespace {

/// Adds stress, pressure and stretches of rows that are as in StressFields::tensors.
void add_tensors(const std::vector<double>& rows, std::size_t numbers, ElementFields& to) {
  for (const double* s = rows.data(); s != rows.data() + rows.size(); s += numbers) {
    to.stress.insert(to.stress.end(), {s[0], s[1], s[2], s[3], s[5], s[4]});
    to.pressure.push_back(-(s[0] + s[1] + s[2]) / 3);
    const double* const c = s + 6;
    Eigen::Matrix3d C;
    C << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> ascending(C, Eigen::EigenvaluesOnly);
    for (const Eigen::Index k : {2, 1, 0})
      to.principal_stretches.push_back(std::sqrt(std::max(0.0, ascending.eigenvalues()[k])));
  }
}

}  // namespace

template <class B>
ElementFields Simulation<B>::element_fields(int level, bool tensors) const {
  const Level<B>& of = impl_->level(level);
  const LedCall led(*impl_, Call::element_fields, level, tensors ? 1 : 0);
  const bool nodal =
      impl_->built.reports[static_cast<std::size_t>(level)].element == name_of(Element::nodal);
  const int rows = nodal ? of.model.vertices : of.model.tets;
  StressFields<B> fields{Scalars<B>("plica::von_mises", rows), Scalars<B>("plica::J", rows)};
  constexpr int numbers = StressFields<B>::numbers;
  if (tensors) {
    fields.tensors = Scalars<B>("plica::tensors", rows * numbers);
    if (nodal)
      fields.of_domains = Scalars<B>("plica::tensors_of_domains", of.model.rows.slots() * numbers);
  }
  if (of.viscosity) of.viscosity->prepare_at(of.exec(), of, impl_->time);
  of.elasticity().stress(of.exec(), of, of.state.u, fields);
  of.exec().fence("plica::element_fields");
  const auto values = [](const Scalars<B>& field) {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), field);
    return std::vector<double>(host.data(), host.data() + host.extent(0));
  };
  ElementFields all{nodal, values(fields.von_mises), values(fields.J)};
  if (tensors) add_tensors(values(fields.tensors), numbers, all);
  if (!of.ranks) return all;
  const auto give = [&](std::vector<double>& of_all, int components) {
    const RankPart& part = of.ranks->part;
    if (nodal)
      of_all = {of_all.begin() + part.first_owned * components,
                of_all.begin() + part.last_owned * components};
    of_all = impl_->given(of_all, components, impl_->joined_tets[static_cast<std::size_t>(level)]);
  };
  give(all.von_mises, 1), give(all.J, 1);
  if (tensors) give(all.stress, 6), give(all.pressure, 1), give(all.principal_stretches, 3);
  return all;
}

namespace {

template <class B, class Snapshot>
void name_snapshot(Snapshot& kept, Archive<B>& archive) {
  for (double* value : {&kept.time, &kept.put_in, &kept.drift[0], &kept.drift[1], &kept.drift[2]})
    archive.number(*value);
  archive.number(kept.steps);
  for (std::size_t i = 0; i < kept.levels.size(); ++i)
    archive.set_level(i), archive.state("a kept level", kept.levels[i]);
  kept.history.name_fields(archive);
}

/// Names the faces that each cut has opened. Returns them, or those that are read. A body that is
/// whole has no such part.
template <class B>
std::vector<Faces> name_cuts(Archive<B>& archive, std::vector<Faces> opened) {
  constexpr std::uint64_t mark = 0x6f70656e66616365;
  if (!archive.part(mark, !opened.empty())) return {};
  opened.resize(archive.count(opened.size()));
  for (Faces& faces : opened) {
    faces.resize(archive.count(faces.size()));
    archive.number(faces.data(), faces.size() * sizeof(Faces::value_type));
  }
  return opened;
}

/// Names how far each blade has come. A state in which no blade cuts has no such part.
template <class B>
void name_fronts(Archive<B>& archive, std::vector<std::optional<BladeFront>>& fronts, int tets) {
  constexpr std::uint64_t mark = 0x626c616465656467;
  std::vector<std::optional<BladeFront>> all = fronts;
  const auto cuts = [](const auto& front) { return front.has_value(); };
  const bool any = archive.part(mark, std::ranges::any_of(all, cuts));
  if (any) archive.same("the number of blades", all.size());
  for (auto& front : all) {
    if (!any || archive.count(cuts(front) ? 1 : 0) == 0) {
      front.reset();
      continue;
    }
    if (!front) front.emplace();
    front->name_fields(archive);
    if (archive.restoring() && !front->fits(static_cast<std::size_t>(tets)))
      throw InputError("the saved state is damaged: a blade is in no element of the mesh");
  }
  if (archive.restoring()) fronts = std::move(all);
}

/// Names the elements that a part which follows an obstacle is made of, and how often it has moved.
/// Returns the elements, or those that are read; none: no part follows an obstacle.
template <class B>
std::optional<std::vector<int>> name_part(Archive<B>& archive,
                                          const std::optional<FollowingPart>& part, long& moves) {
  constexpr std::uint64_t mark = 0x666f6c6c6f77696e;
  if (!archive.part(mark, part.has_value())) return {};
  archive.number(moves);
  std::vector<int> refined = part ? part->refined : std::vector<int>();
  refined.resize(archive.count(refined.size()));
  archive.number(refined.data(), refined.size() * sizeof(int));
  return refined;
}

/// Names to the archive all that is carried from one macro step to the next, in a fixed order.
template <class B, class Impl>
void name_all(Impl& s, Archive<B>& archive) {
  name_cuts<B>(archive, s.opened);
  name_part<B>(archive, s.problem.body.following, s.part_moves.moves);
  archive.same("the precision", sizeof(typename B::Real));
  archive.same("the macro step", s.built.macro_step);
  archive.same("the number of levels", s.kept.levels.size());
  for (double* value : {&s.time, &s.origin, &s.residual, &s.worst_residual, &s.start, &s.put_in,
                        &s.drift[0], &s.drift[1], &s.drift[2]})
    archive.number(*value);
  for (long* value : {&s.steps, &s.rejected, &s.unsolved}) archive.number(*value);
  s.control.name_fields(archive);
  archive.number(s.budget_opens);
  for (std::size_t i = 0; i < s.kept.levels.size(); ++i) {
    archive.set_level(i);
    s.hierarchy().levels[i].name_fields(archive, "level " + std::to_string(i) + "'s ");
  }
  s.built.stepper->name_fields(archive);
  archive.field("the obstacles' wrenches", s.wrench);
  archive.field("the obstacles' memory", s.memory);
  name_snapshot<B>(s.kept, archive);
  if (s.fallback) name_snapshot<B>(*s.fallback, archive);
  s.motions.name_fields(archive);
  name_fronts<B>(archive, s.fronts, s.built.reports.front().tets);
  archive.finish();
}

}  // namespace

template <class B>
SavedState Simulation<B>::save() const {
  using Archive = Archive<B>;
  const LedCall led(*impl_, Call::save);
  impl_->hierarchy().exec().fence("plica::save");
  SavedState saved;
  const auto shared = impl_->shared_fields();
  Archive archive(Archive::Task::save, saved.bytes, shared.get());
  name_all<B>(*impl_, archive);
  if (impl_->ranks && impl_->ranks->own() > 0) saved.bytes.clear();  // rank 0 has whole fields
  return saved;
}

template <class B>
void Simulation<B>::restore(const SavedState& saved) {
  using Archive = Archive<B>;
  const LedCall led(*impl_, Call::restore);
  impl_->hierarchy().exec().fence("plica::restore");
  std::vector<unsigned char> bytes = impl_->bytes_of_first(saved.bytes);
  const auto shared = impl_->shared_fields();
  std::unique_ptr<Impl> next;  // none: its mesh is that of the state
  const auto check = [&] {
    Archive meshes(Archive::Task::restore, bytes), all(Archive::Task::check, bytes, shared.get());
    const std::vector<Faces> opened = name_cuts<B>(meshes, {});
    long moves = 0;
    const std::optional<std::vector<int>> part = name_part<B>(meshes, {}, moves);
    if (!opened.empty() || part)
      impl_->expect_one_process("the saved state of a body that was cut");
    next = impl_->reopened(opened);
    if (!next) next = impl_->with_saved_part(part);
    name_all<B>(next ? *next : *impl_, all);
  };
  impl_->ranks ? impl_->ranks->together(check) : check();
  if (next) {
    next->go_on_from(*impl_);
    impl_ = std::move(next);
  }
  Archive all(Archive::Task::restore, bytes, shared.get());
  name_all<B>(*impl_, all);
  impl_->cut_until = impl_->time, impl_->looked_at = -1;
  if (const Contact<B>* contact = impl_->hierarchy()[0].contact())
    impl_->motions.restore_snapshot(*contact, impl_->time);
  if (impl_->motions.commanded()) impl_->budget_known = false;
  impl_->hierarchy().clear_flags();
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
