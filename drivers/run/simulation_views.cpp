// SPDX-License-Identifier: BSD-3-Clause
// Queries of a simulation; and saving and restoring what it carries from one macro step to the
// next.
#include <algorithm>
#include <plica/core/state_archive.hpp>
#include <plica/core/text.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/loads/exchange.hpp>
#include <plica/drivers/run/move_obstacles.hpp>
#include <plica/drivers/run/simulation_inside.hpp>
#include <plica/drivers/run/validate.hpp>

namespace plica {

template <class B>
const SolverLevel<B>& Simulation<B>::Inside::level(int i) {
  if (const int last = hierarchy().count() - 1; i < 0 || i > last)
    throw InputError("level " + std::to_string(i) +
                     " has no state of its own: the cycle integrates " +
                     (last > 0 ? "levels 0 to " + std::to_string(last) : "level 0") + " alone");
  return hierarchy()[i];
}

template <class B>
const Vectors<B>& Simulation<B>::Inside::rest_positions(int i) {
  level(i);  // throws where there is no such level
  Vectors<B>& x = rest[static_cast<std::size_t>(i)];
  if (x.extent(0) == 0)
    x = to_device<Vectors<B>>(
        "rest", rows<typename B::Real>(built.meshes[static_cast<std::size_t>(i)].vertices));
  return x;
}

template <class B>
double Simulation<B>::time() const {
  return inside_->time;
}
template <class B>
double Simulation<B>::macro_step() const {
  return inside_->built.macro_step;
}
template <class B>
long Simulation<B>::macro_steps() const {
  return inside_->steps;
}
template <class B>
const std::vector<LevelReport>& Simulation<B>::levels() const {
  return inside_->built.reports;
}
template <class B>
std::optional<HimReport> Simulation<B>::him() const {
  return inside_->built.him;
}
template <class B>
std::vector<Part> Simulation<B>::parts() const {
  return list_parts<B>(inside_->problem, inside_->built);
}
template <class B>
Energies Simulation<B>::energies() const {
  return inside_->meter.all(inside_->time);
}

template <class B>
Doubles<B> Simulation<B>::wrench() const {
  return inside_->wrench;
}
template <class B>
std::vector<ToolState> Simulation<B>::tools() const {
  const auto& obstacles = inside_->problem.contact.obstacles;
  if (std::ranges::none_of(obstacles, [](const ObstacleOptions& o) { return o.mass.has_value(); }))
    return {};
  const std::vector<double> all = host_values(inside_->hierarchy().exec(), inside_->memory);
  std::vector<ToolState> tools;
  for (std::size_t o = 0; o < obstacles.size(); ++o) {
    if (!obstacles[o].mass) continue;
    using Place = ObstaclePlace<B>;
    const double* const own = all.data() + o * Place::numbers;
    ToolState tool{obstacle_name(inside_->problem.contact, o), Point(own), Point(own + 3),
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
  return inside_->hierarchy()[0].cavities(inside_->time);
}

template <class B>
void Simulation<B>::set_external_forces(const ExternalForces<B>& forces) {
  Inside& s = *inside_;
  for (int i = 0; i < s.hierarchy().count(); ++i)
    s.hierarchy()[i].set_external(forces, s.rest_positions(i));
  if (forces) s.budget_known = false;
}

template <class B>
void Simulation<B>::use_graphs(bool on) {
  inside_->graphs = on;
}

template <class B>
void Simulation<B>::share_cores() {
  if (!inside_->cores) inside_->cores.emplace(inside_->hierarchy().exec());
}

template <class B>
void Simulation<B>::time_stages(bool on) {
  inside_->hierarchy().clock.on = on;
}

template <class B>
std::map<std::string, double> Simulation<B>::stages() const {
  return inside_->hierarchy().clock.seconds();
}

template <class B>
std::map<std::string, long> Simulation<B>::counters() const {
  std::map<std::string, long> all = inside_->built.stepper->counters();
  for (const auto& level : inside_->hierarchy().levels) {
    all["force_evaluations"] += level.evaluations();
    long passes = level.evaluations();  // passes over the elements
    for (const auto& [name, count] : level.integrator->counters()) {
      all[name] += count;
      if (name == "cg_iterations") passes += count;
    }
    all["tet_evaluations"] += passes * level.model.tets;
  }
  if (gathers<Exec>)
    all["launches_in_graphs"] = inside_->queue.in_graphs(),
    all["launches_alone"] = inside_->queue.alone();
  const Inside& s = *inside_;
  if (s.control.halves())
    all["step_halvings"] = s.control.halvings(), all["rejected_steps"] = s.rejected;
  if (all.contains("newton_iterations")) all["newton_misses"] = s.unsolved;
  return all;
}

template <class B>
double Simulation<B>::residual() const {
  return inside_->residual;
}
template <class B>
double Simulation<B>::worst_residual() const {
  return inside_->worst_residual;
}

template <class B>
Vectors<B> Simulation<B>::displacement(int level) const {
  return inside_->level(level).state.u;
}
template <class B>
Vectors<B> Simulation<B>::velocity(int level) const {
  return inside_->level(level).state.v;
}

template <class B>
void Simulation<B>::read_positions(const DeviceOutput<B>& to, int level) const {
  plica::read_positions<B>(inside_->hierarchy().exec(), inside_->rest_positions(level),
                           displacement(level), to);
}
template <class B>
void Simulation<B>::read_velocities(const DeviceOutput<B>& to, int level) const {
  read_vectors<B>(inside_->hierarchy().exec(), velocity(level), to);
}
template <class B>
void Simulation<B>::read_surface_positions(const DeviceOutput<B>& to) const {
  const Level<B>& finest = inside_->level(0);
  read_surface<B>(inside_->hierarchy().exec(), finest.surface, finest.state, false, to);
}
template <class B>
void Simulation<B>::read_surface_velocities(const DeviceOutput<B>& to) const {
  const Level<B>& finest = inside_->level(0);
  read_surface<B>(inside_->hierarchy().exec(), finest.surface, finest.state, true, to);
}

template <class B>
void Simulation<B>::write_state(const DeviceInput<B>& positions, const DeviceInput<B>& velocities) {
  const State<B>& state = inside_->level(0).state;
  if (velocities.size() != positions.size())  // before anything is written
    throw InputError(std::to_string(positions.size()) + " positions and " +
                     std::to_string(velocities.size()) + " velocities");
  inside_->remember();
  write_positions<B>(inside_->hierarchy().exec(), positions, inside_->rest_positions(0), state.u);
  write_vectors<B>(inside_->hierarchy().exec(), velocities, state.v);
  inside_->restart();
}

template <class B>
std::vector<Point> Simulation<B>::positions(int level) const {
  std::vector<Point> x = to_host<B>(inside_->hierarchy().exec(), displacement(level));
  const auto& rest = inside_->built.meshes[static_cast<std::size_t>(level)].vertices;
  for (std::size_t a = 0; a < x.size(); ++a) x[a] += rest[a];
  return x;
}
template <class B>
std::vector<Point> Simulation<B>::velocities(int level) const {
  return to_host<B>(inside_->hierarchy().exec(), velocity(level));
}
template <class B>
std::vector<Point> Simulation<B>::surface_positions() const {
  const Vectors<B> x("plica::surface.x", inside_->level(0).surface.points);
  read_surface_positions(x);
  return to_host<B>(inside_->hierarchy().exec(), x);
}
template <class B>
std::vector<Point> Simulation<B>::surface_velocities() const {
  const Vectors<B> v("plica::surface.v", inside_->level(0).surface.points);
  read_surface_velocities(v);
  return to_host<B>(inside_->hierarchy().exec(), v);
}

template <class B>
ElementFields Simulation<B>::element_fields(int level) const {
  const SolverLevel<B>& of = inside_->level(level);
  const bool nodal = of.model.rows.slices > 0;
  const int rows = nodal ? of.model.vertices : of.model.tets;
  const Scalars<B> von_mises("plica::von_mises", rows), J("plica::J", rows);
  if (of.viscosity) of.viscosity->look_at(of.exec(), of, inside_->time);
  of.elasticity().stress(of.exec(), of, of.state.u, von_mises, J);
  of.exec().fence("plica::element_fields");
  const auto values = [](const Scalars<B>& field) {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), field);
    return std::vector<double>(host.data(), host.data() + host.extent(0));
  };
  return {nodal, values(von_mises), values(J)};
}

namespace {

template <class B, class Kept>
void persist_kept(Kept& kept, StateArchive<B>& archive) {
  for (double* value : {&kept.time, &kept.put_in, &kept.drift[0], &kept.drift[1], &kept.drift[2]})
    archive.number(*value);
  archive.number(kept.steps);
  for (const auto& state : kept.levels) archive.state("a kept level", state);
  for (auto& stress : kept.stress)
    archive.field("a kept memory of stress", stress.memory), archive.number(stress.time);
  archive.field("the kept memory of obstacles", kept.memory);
  for (auto& contact : kept.contact) contact.persist(archive);
}

/// Names to the archive all that is carried from one macro step to the next, in a fixed order.
template <class B, class Inside>
void persist(Inside& s, StateArchive<B>& archive) {
  archive.same("the precision", sizeof(typename B::Real));
  archive.same("the macro step", s.built.macro_step);
  archive.same("the number of levels", s.kept.levels.size());
  for (double* value : {&s.time, &s.origin, &s.residual, &s.worst_residual, &s.start, &s.put_in,
                        &s.drift[0], &s.drift[1], &s.drift[2]})
    archive.number(*value);
  for (long* value : {&s.steps, &s.rejected, &s.unsolved}) archive.number(*value);
  s.control.persist(archive);
  archive.number(s.budget_opens);
  for (std::size_t i = 0; i < s.kept.levels.size(); ++i)
    s.hierarchy().levels[i].persist(archive, "level " + std::to_string(i) + "'s ");
  s.built.stepper->persist(archive);
  archive.field("the obstacles' wrenches", s.wrench);
  archive.field("the obstacles' memory", s.memory);
  persist_kept<B>(s.kept, archive);
  if (s.older) persist_kept<B>(*s.older, archive);
  archive.finish();
}

}  // namespace

template <class B>
SavedState Simulation<B>::save() const {
  using Archive = StateArchive<B>;
  inside_->hierarchy().exec().fence("plica::save");
  SavedState saved;
  Archive archive(Archive::Task::save, saved.bytes);
  persist<B>(*inside_, archive);
  return saved;
}

template <class B>
void Simulation<B>::restore(const SavedState& saved) {
  using Archive = StateArchive<B>;
  inside_->hierarchy().exec().fence("plica::restore");
  std::vector<unsigned char> bytes = saved.bytes;
  for (const auto task : {Archive::Task::check, Archive::Task::restore}) {
    Archive archive(task, bytes);
    persist<B>(*inside_, archive);
  }
  inside_->hierarchy().clear_flags();
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
