// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <plica/core/precision.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/scene/input_diagnosis.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/python/any_simulation.hpp>
#include <plica/drivers/python/kokkos_session.hpp>
#include <stdexcept>

namespace plica::python {

std::shared_ptr<Values> AnySimulation::live(Field field, int level) {
  for (const Live& one : lives_)
    if (one.field == field && one.level == level)
      if (auto values = one.values.lock()) return values;
  auto values = std::make_shared<Values>();
  read(field, level, *values);
  std::erase_if(lives_, [](const Live& one) { return one.values.expired(); });
  lives_.push_back({field, level, values});
  return values;
}

void AnySimulation::refresh() {
  for (const Live& one : lives_)
    if (const auto values = one.values.lock()) read(one.field, one.level, *values);
}

namespace {

template <class B>
class SimulationOf final : public AnySimulation {
 public:
  SimulationOf(std::shared_ptr<const app::Scene> scene, const std::optional<CycleChoice>& choice)
      : scene_(std::move(scene)),
        choice_(choice),
        simulation_(with_choice(scene_->problem, choice)),
        surface_points_(simulation_.surface_positions().size()) {
    if (!scene_->numbering.empty()) level0_ = scene_->numbering.front();
    simulation_.share_cores();
  }

  std::optional<Diagnosis> advance(double until, long at_most,
                                   const std::function<void()>& between) override {
    const double rounding = 1e-9 * simulation_.macro_step();
    std::optional<Diagnosis> bad;
    try {
      for (; at_most > 0 && !bad && simulation_.time() < until - rounding; --at_most) {
        const auto start = std::chrono::steady_clock::now();
        bad = step();
        follow_mesh();
        wall_time_ +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        between();
      }
    } catch (...) {
      follow_mesh(), refresh();
      throw;
    }
    if (bad) simulation_.return_to_last_good();
    follow_mesh(), refresh();
    return bad;
  }
  std::vector<Wrench> wrenches() const override { return simulation_.wrenches(); }
  std::vector<Reaction> reactions() const override { return simulation_.reactions(); }
  std::vector<double> contact_depths() const override { return simulation_.contact_depths(); }
  std::vector<ToolState> tools() const override { return simulation_.tools(); }
  std::vector<HeldBy> held() const override { return simulation_.held(); }
  void grasp(int obstacle) override { changing().grasp(obstacle); }
  void release(int obstacle) override { changing().release(obstacle); }
  std::vector<CavityState> cavities() const override { return simulation_.cavities(); }
  void move_obstacle(int obstacle, const Point& displacement,
                     const std::optional<Point>& rotation) override {
    if (rotation)
      changing().move_obstacle(obstacle, displacement, *rotation);
    else
      changing().move_obstacle(obstacle, displacement);
  }
  void set_obstacle_motion(int obstacle, const std::optional<Motion>& motion,
                           const std::optional<Turn>& turn) override {
    if (motion) changing().set_obstacle_motion(obstacle, *motion);
    if (turn) changing().set_obstacle_turn(obstacle, turn);
  }
  std::vector<ObstaclePlace> obstacles() const override {
    std::vector<ObstaclePlace> all;
    const ContactOptions& contact = scene_->problem.contact;
    for (std::size_t o = 0; o < contact.obstacles.size(); ++o) {
      const int i = static_cast<int>(o);
      all.push_back({obstacle_name(contact, o), simulation_.obstacle_displacement(i),
                     simulation_.obstacle_rotation(i), simulation_.obstacle_origin(i)});
    }
    return all;
  }
  CutReport cut(const Blade& blade) override {
    const CutReport report = changing().cut(blade);
    follow_mesh();
    return report;
  }
  void set_gravity(const Point& gravity) override {
    expect_between_steps();
    simulation_.set_gravity(gravity);
  }
  void set_time(double time) override { changing().set_time(time); }
  void end_at(double time) override { simulation_.end_at(time); }

  ElementFields element_fields(int level, bool tensors) const override {
    ElementFields fields = simulation_.element_fields(level, tensors);
    const Reordering& order = numbering(level).input;
    const auto& rows = fields.per_vertex ? order.vertices : order.tets;
    ElementFields sorted{fields.per_vertex, app::in_input_order(fields.von_mises, rows),
                         app::in_input_order(fields.J, rows)};
    if (!tensors) return sorted;
    sorted.stress = app::in_input_order(fields.stress, rows, 6);
    sorted.pressure = app::in_input_order(fields.pressure, rows);
    sorted.principal_stretches = app::in_input_order(fields.principal_stretches, rows, 3);
    return sorted;
  }
  std::vector<double> contact_pressure() const override { return simulation_.contact_pressure(); }

  double time() const override { return simulation_.time(); }
  double macro_step() const override { return simulation_.macro_step(); }
  long macro_steps() const override { return simulation_.macro_steps(); }
  Energies energies() const override { return simulation_.energies(); }
  std::vector<LevelReport> levels() const override {
    return app::in_input_numbers(simulation_.levels(), *scene_);
  }
  std::map<std::string, long> counters() const override { return simulation_.counters(); }
  double residual() const override { return simulation_.residual(); }
  std::string precision() const override {
    return std::is_same_v<typename B::Real, float> ? "float" : "double";
  }

  void set_state(const Values& positions, const Values& velocities) override {
    const std::vector<int> order = numbering(0).input.vertices;
    const Rows x = on_device(positions, order), v = on_device(velocities, order);
    changing().write_state(DeviceInput<B>(x), DeviceInput<B>(v));
    Kokkos::fence("plica::set_state");
    refresh();
  }

  void set_forces(HostForces forces) override {
    if constexpr (!B::on_host) throw InputError("forces of one's own need a back end on the host");
    expect_between_steps();
    forces_ = {};
    if (forces)
      forces_ = [this, forces = std::move(forces)](const ForceRequest<B>& request) {
        add_forces(request, forces);
      };
    simulation_.set_external_forces(forces_);
    simulation_.keep_step_starts(static_cast<bool>(forces_));
  }

  SavedState save() const override { return simulation_.save(); }
  void restore(const SavedState& saved) override {
    changing().restore(saved);
    follow_mesh(), refresh();
  }
  void reset() override {
    if (!start_) start_ = fresh_ ? save() : SimulationOf(scene_, choice_).save();
    restore(*start_);
  }

  void start_files(const std::filesystem::path& folder) override {
    app::make_folder(folder);
    files_.emplace(*scene_, folder);
    folder_ = folder;
  }
  void write_frame(const std::string& status, const std::optional<Diagnosis>& diagnosis) override {
    files_->follow_mesh(simulation_);
    if (files_->frames() == 0 || files_->last_time() < simulation_.time())
      files_->write(
          app::take_snapshot(simulation_, simulation_.time(), files_->volumes(), files_->output()));
    app::Summary summary;
    summary.status = status, summary.diagnosis = diagnosis;
    summary.simulated_time = simulation_.time(), summary.last_good_time = files_->last_time();
    summary.macro_step = simulation_.macro_step(), summary.macro_steps = simulation_.macro_steps();
    summary.wall_time = wall_time_, summary.frames = files_->frames();
    summary.precision = precision(), summary.backend = B::Exec::name(),
    summary.threads = typename B::Exec().concurrency();
    summary.choice = choice_, summary.cycle = app::cycle_name(*scene_, choice_);
    summary.levels = levels(), summary.counters = counters(), summary.wrenches = wrenches(),
    summary.reactions = reactions(), summary.tools = tools();
    summary.held = held();
    summary.residual = simulation_.worst_residual();
    if (!simulation_.twins().empty()) summary.cuts = simulation_.cuts();
    if (scene_->problem.body.following) summary.followed = simulation_.followed();
    app::write_file(folder_ / "summary.json",
                    app::summary_json(*scene_, summary, {"import plica"}));
  }

  void show_live(app::LiveOptions options) override {
    options.method = app::live_method(*scene_, simulation_, choice_);
    app::show_live(*scene_, changing(), options, forces_);
    refresh();
  }

 private:
  using Rows = Kokkos::View<double* [3], Kokkos::LayoutRight, typename B::Memory>;
  using HostRows = Kokkos::View<double* [3], Kokkos::LayoutRight, Kokkos::HostSpace,
                                Kokkos::MemoryTraits<Kokkos::Unmanaged>>;

  void expect_between_steps() const {
    if (stepping_)
      throw std::runtime_error(
          "this simulation is within a step, which asks for forces; expected changes between "
          "steps");
  }
  /// Returns the simulation, to change what save() stores. Throws std::runtime_error within a step.
  Simulation<B>& changing() {
    expect_between_steps();
    fresh_ = false;
    return simulation_;
  }

  std::optional<Diagnosis> step() {
    Simulation<B>& simulation = changing();
    stepping_ = true;
    try {
      auto bad = simulation.step_checked();
      if (bad) bad = app::in_input_numbers(*bad, *scene_);
      stepping_ = false;
      return bad;
    } catch (...) {  // thrown by a caller's force or by Ctrl-C within the step
      simulation.return_to_step_start();
      stepping_ = false;
      throw;
    }
  }

  const app::Numbering& numbering(int level) const {
    const std::size_t meshes = std::min(simulation_.levels().size(), scene_->numbering.size());
    if (level < 0 || static_cast<std::size_t>(level) >= meshes)
      throw InputError("level: there is no level " + std::to_string(level) +
                       "; the simulation has " + std::to_string(meshes) +
                       ", counted from 0, the finest");
    return level == 0 ? level0_ : scene_->numbering[static_cast<std::size_t>(level)];
  }

  /// Takes over the sizes of a body that was cut, whose new vertices and points are the last ones,
  /// or whose part has moved.
  void follow_mesh() {
    if (simulation_.mesh_changes() == mesh_changes_) return;
    mesh_changes_ = simulation_.mesh_changes();
    const std::size_t count = simulation_.mesh().vertices.size();
    std::vector<int>& input = level0_.input.vertices;
    for (std::size_t v = input.size(); !input.empty() && v < count; ++v)
      input.push_back(static_cast<int>(v));
    surface_points_ = simulation_.surface() ? simulation_.surface()->vertices.size() : 0;
    leave_live();
  }

  void read(Field field, int level, Values& to) const override {
    const bool of_surface = field != Field::positions && field != Field::velocities;
    const std::vector<int>& order = numbering(level).input.vertices;
    const std::size_t rows =
        of_surface ? surface_points_
                   : static_cast<std::size_t>(
                         simulation_.levels()[static_cast<std::size_t>(level)].vertices);
    to.resize(3 * rows);
    if (of_surface || order.empty()) return read_rows(field, level, to);
    Values here(to.size());
    read_rows(field, level, here);
    for (std::size_t i = 0; i < rows; ++i)
      std::copy_n(&here[3 * static_cast<std::size_t>(order[i])], 3, &to[3 * i]);
  }

  /// Reads a field in the order of the simulation
  void read_rows(Field field, int level, Values& to) const {
    if (to.empty()) return;
    const HostRows host(to.data(), to.size() / 3);
    const auto rows =
        Kokkos::create_mirror_view(Kokkos::WithoutInitializing, typename B::Memory(), host);
    const DeviceOutput<B> output(rows);
    if (field == Field::positions) simulation_.read_positions(output, level);
    if (field == Field::velocities) simulation_.read_velocities(output, level);
    if (field == Field::surface_positions) simulation_.read_surface_positions(output);
    if (field == Field::surface_velocities) simulation_.read_surface_velocities(output);
    if (field == Field::surface_normals) simulation_.read_surface_normals(output);
    Kokkos::fence("plica::read");
    Kokkos::deep_copy(host, rows);  // copies nothing if both are one view
  }

  /// Copies values in input order to the device, in the order of the simulation
  Rows on_device(const Values& values, const std::vector<int>& order) const {
    const Rows rows("plica::rows", values.size() / 3);
    const auto host = Kokkos::create_mirror_view(rows);
    for (std::size_t i = 0; i < rows.extent(0); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        host(order.empty() ? i : static_cast<std::size_t>(order[i]), k) = values[3 * i + k];
    Kokkos::deep_copy(rows, host);
    return rows;
  }

  void add_forces(const ForceRequest<B>& request, const HostForces& forces) const {
    using Real = typename B::Real;
    request.exec.fence("plica::forces");
    const std::vector<int>& order = numbering(request.level).input.vertices;
    const auto here = [&](std::size_t i) {
      return i < order.size() ? static_cast<std::size_t>(order[i])
                              : i;  // vertices of a cut come last
    };
    const std::size_t n = request.rest.extent(0);
    Values x(3 * n), v(3 * n), f(3 * n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        x[3 * i + k] = static_cast<double>(request.rest(here(i), k)) +
                       static_cast<double>(request.displacement(here(i), k));
        v[3 * i + k] = static_cast<double>(request.velocity(here(i), k));
      }
    forces(request.level, request.time, x, v, f);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        request.force(here(i), k) += static_cast<Real>(f[3 * i + k]);
  }

  std::shared_ptr<const app::Scene> scene_;
  std::optional<CycleChoice> choice_;
  Simulation<B> simulation_;
  app::Numbering level0_;  // numbering of level 0, with the vertices that cuts have added
  std::size_t surface_points_;
  long mesh_changes_ = 0;  // number of changes of the mesh that were taken over
  ExternalForces<B> forces_;
  bool fresh_ = true, stepping_ = false;  // nothing has changed since the set-up; within step()
  std::optional<SavedState> start_;
  double wall_time_ = 0;  // wall time of the steps [s]
  std::optional<app::RunFiles> files_;
  std::filesystem::path folder_;
};

template <class B>
std::unique_ptr<AnySimulation> make(std::shared_ptr<const app::Scene> scene) {
  try {
    return std::make_unique<SimulationOf<B>>(
        scene, choose_cycle<B>(scene->problem, {scene->duration, {}}));
  } catch (const SubstepRefused& error) {
    throw app::located(app::in_input_numbers(error, *scene), scene->source);
  } catch (const InputError& error) {
    throw app::located(error, scene->source);
  }
}

}  // namespace

std::unique_ptr<AnySimulation> make_simulation(std::shared_ptr<const app::Scene> scene,
                                               const std::string& precision) {
  start_kokkos();
  using Exec = Kokkos::DefaultExecutionSpace;
  return in_precision<Exec>(
      precision, [&]<class B>(std::type_identity<B>) { return make<B>(std::move(scene)); });
}

}  // namespace plica::python
