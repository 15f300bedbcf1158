// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <mutex>
#include <nlohmann/json.hpp>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/report/page.hpp>
#include <plica/drivers/app/scene/input_diagnosis.hpp>
#include <plica/drivers/app/view/live_view.hpp>
#include <plica/drivers/app/view/user_forces.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/base64.hpp>
#include <set>
#include <thread>

namespace plica::app {
namespace {

using LiveJson = nlohmann::ordered_json;
using LiveClock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds frame_time(33);
// maximum delay of the simulated time, in seconds of the clock; a longer delay is dropped
constexpr double longest_debt = 0.1;

constexpr double obstacle_speed = 1;  // maximum speed, in body sizes per simulated second

double seconds(LiveClock::duration time) { return std::chrono::duration<double>(time).count(); }

LiveJson three_of(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// Surface of the body that the page shows: the boundary of level 0.
struct Skin {
  BoundarySurface boundary;
  Point low, high;
  explicit Skin(const Body& body) : boundary(boundary_surface(body.levels.front())) {
    for (Point& p : boundary.surface.vertices) p += placement_of(body);
    low = high = boundary.surface.vertices.front();
    for (const Point& p : boundary.surface.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  double size() const { return (high - low).norm(); }
  std::vector<float> of(const std::vector<Point>& points) const {
    std::vector<float> values;
    for (const int v : boundary.mesh_vertex)
      for (int k = 0; k < 3; ++k)
        values.push_back(static_cast<float>(points[static_cast<std::size_t>(v)][k]));
    return values;
  }
};

/// Speed of the simulation, averaged over about the last second (time constant 0.7 s).
class Speed {
 public:
  void add(double simulated, double stepping, LiveClock::duration wall) {
    const double keep = std::exp(-seconds(wall) / 0.7);
    simulated_ = keep * simulated_ + simulated, stepping_ = keep * stepping_ + stepping;
    wall_ = keep * wall_ + seconds(wall);
  }
  double now() const { return wall_ > 0 ? simulated_ / wall_ : 0; }
  double possible() const { return stepping_ > 0 ? simulated_ / stepping_ : 0; }

 private:
  double simulated_ = 0, stepping_ = 0, wall_ = 0;
};

template <class B>
class LiveView {
 public:
  LiveView(const Scene& scene, Simulation<B>& simulation, const LiveOptions& options,
           const ExternalForces<B>& forces)
      : scene_(scene),
        simulation_(simulation),
        options_(options),
        forces_(forces),
        skin_(scene.problem.body),
        hands_(scene, simulation, skin_.size()),
        first_(simulation.save()) {
    said_.gravity = scene.problem.gravity.norm();
    simulation_.set_external_forces([this](const ForceRequest<B>& request) {
      if (forces_) forces_(request);
      hands_(request);
    });
    simulation_.share_cores();
  }
  ~LiveView() { simulation_.set_external_forces(forces_); }
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  void run() {
    WebServer server(options_.port, page(), [this](const std::string& text) { return take(text); });
    if (options_.listening)
      options_.listening(fmt::format("http://127.0.0.1:{}", options_.port.number()));
    auto due = LiveClock::now(), before = due;
    while (!options_.ended || !options_.ended()) {
      const Controls controls = said();
      start_again(controls);
      const bool stepped = server.watchers() > 0 && controls.running && words_.empty() &&
                           keep_pace(controls, before);
      const auto now = LiveClock::now();
      speed_.add(0, 0, now - before);
      before = now;
      if (server.watchers() > 0 && now >= due)
        server.publish(frame(controls)),
            due = LiveClock::now() + (controls.running ? frame_time : 5 * frame_time);
      if (!stepped) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

 private:
  Controls said() {
    const std::lock_guard lock(mutex_);
    return said_;
  }

  std::string take(const std::string& text) {
    try {
      const Controls controls = controls_of(text);
      const std::lock_guard lock(mutex_);
      said_ = controls;
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  void start_again(const Controls& controls) {
    if (controls.restarts == restarts_) return;
    restarts_ = controls.restarts;
    for (const int number : moved_)
      simulation_.set_obstacle_motion(number, obstacles()[static_cast<std::size_t>(number)].motion);
    moved_.clear();
    simulation_.restore(first_);
    words_.clear();
  }

  // Takes a macro step if one is due; returns whether it did
  bool keep_pace(const Controls& controls, LiveClock::time_point before) {
    const auto start = LiveClock::now();
    debt_ += controls.speed * seconds(start - before);
    if (debt_ <= 0) return false;
    const double time = simulation_.time();
    hands_.hold(controls, time);
    move_obstacles_to(controls.moved);
    if (const auto bad = simulation_.step_checked()) {
      simulation_.return_to_last_good();
      if (hands_.give_way()) return true;
      words_ = in_input_numbers(*bad, scene_).text();
      return false;
    }
    hands_.advance();
    const double simulated = simulation_.time() - time;
    debt_ = std::min(debt_ - simulated, longest_debt * controls.speed);
    speed_.add(simulated, seconds(LiveClock::now() - start), {});
    return true;
  }

  const std::vector<ObstacleOptions>& obstacles() const { return scene_.problem.contact.obstacles; }

  // Moves obstacles towards their targets, at a bounded speed
  void move_obstacles_to(const std::vector<ObstacleAim>& aims) {
    const double reach = obstacle_speed * skin_.size() * simulation_.macro_step();
    for (const ObstacleAim& aim : aims) {
      if (aim.obstacle >= static_cast<int>(obstacles().size())) continue;
      const Point now = simulation_.obstacle_displacement(aim.obstacle),
                  way = aim.displacement - now;
      simulation_.move_obstacle(aim.obstacle,
                                now + way * std::min(1.0, reach / std::max(way.norm(), 1e-300)));
      moved_.insert(aim.obstacle);
    }
  }

  // Returns displacement [m] and force [N] of the obstacles that the user moves
  LiveJson moved() const {
    LiveJson list = LiveJson::array();
    if (moved_.empty()) return list;
    const std::vector<Wrench> wrenches = simulation_.wrenches();
    for (const int number : moved_)
      list.push_back({{"obstacle", number},
                      {"displacement", three_of(simulation_.obstacle_displacement(number))},
                      {"push", wrenches[static_cast<std::size_t>(number)].force.norm()}});
    return list;
  }

  std::string page() const {
    const Problem& problem = scene_.problem;
    const double young = stiffness_at_rest(problem.body.material), size = skin_.size();
    std::vector<std::uint32_t> corners;
    for (const auto& triangle : skin_.boundary.surface.triangles)
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    std::vector<float> rest;
    for (const Point& p : skin_.boundary.surface.vertices)
      for (int k = 0; k < 3; ++k) rest.push_back(static_cast<float>(p[k]));
    int tets = 0;
    for (const LevelReport& level : simulation_.levels()) tets += level.tets;
    const LiveJson data = {
        {"title", scene_.name},
        {"up", problem.gravity.norm() > 0 ? three_of(-problem.gravity) : LiveJson({0, 0, 1})},
        {"gravity", problem.gravity.norm()},
        {"stiffness", 0.03 * young * size},
        {"size", size},
        {"method", options_.method},
        {"tets", tets},
        {"rest", base64(rest)},
        {"triangles", base64(corners)},
        {"obstacles", obstacles_json(problem.contact)}};
    return filled_page(live_files(), scene_.name,
                       data.dump(-1, ' ', false, LiveJson::error_handler_t::replace));
  }

  std::string frame(const Controls& controls) const {
    const auto& tool = hands_.tool();
    const std::vector<float> values = values_of(controls.colour);
    const LiveJson data = {{"time", simulation_.time()},
                           {"speed", speed_.now()},
                           {"possible", speed_.possible()},
                           {"pull", words_.empty() ? hands_.pull().norm() : 0.0},
                           {"push", words_.empty() ? hands_.push().norm() : 0.0},
                           {"tool", tool ? three_of(tool->centre) : LiveJson()},
                           {"moved", moved()},
                           {"wrong", words_},
                           {"colour", controls.colour},
                           {"values", values.empty() ? LiveJson() : LiveJson(base64(values))},
                           {"points", base64(skin_.of(simulation_.positions()))}};
    return data.dump(-1, ' ', false, LiveJson::error_handler_t::replace);
  }

  // Returns the values that colour each vertex of the surface. Empty: the page computes them, or
  // there are none
  std::vector<float> values_of(const std::string& colour) const {
    std::vector<double> all;
    if (colour == "speed")
      for (const Point& v : simulation_.velocities()) all.push_back(v.norm());
    if (colour == "von_mises" || colour == "J") {
      const ElementFields fields = simulation_.element_fields();
      all = at_vertices(fields, colour == "J" ? fields.J : fields.von_mises);
    }
    std::vector<float> values;
    if (!all.empty())
      for (const int v : skin_.boundary.mesh_vertex)
        values.push_back(static_cast<float>(all[static_cast<std::size_t>(v)]));
    return values;
  }

  // Returns values at vertices. For linear elements it is the mean over the tetrahedra at a vertex
  std::vector<double> at_vertices(const ElementFields& fields,
                                  const std::vector<double>& values) const {
    if (fields.per_vertex) return values;
    const TetMesh& mesh = scene_.problem.body.levels.front();
    std::vector<double> sum(mesh.vertices.size()), count(mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (const int v : mesh.tets[t])
        sum[static_cast<std::size_t>(v)] += values[t], ++count[static_cast<std::size_t>(v)];
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= std::max(count[v], 1.0);
    return sum;
  }

  const Scene& scene_;
  Simulation<B>& simulation_;
  const LiveOptions& options_;
  ExternalForces<B> forces_;
  Skin skin_;
  UserForces<B> hands_;
  SavedState first_;
  std::mutex mutex_;  // protects said_
  Controls said_;
  int restarts_ = 0;
  std::set<int> moved_;  // obstacles that the user has moved since the start
  double debt_ = 0;      // simulated time that is due [s]
  Speed speed_;
  std::string words_;  // why the simulation cannot continue; empty: it can
};

}  // namespace

template <class B>
std::string live_method(const Scene& scene, const Simulation<B>& simulation,
                        const std::optional<CycleChoice>& choice) {
  int tets = 0;
  for (const LevelReport& level : simulation.levels()) tets += level.tets;
  std::string text =
      fmt::format("{} tetrahedra, {}, macro step {}", tets,
                  choice ? "cycle " + choice->cycle : "cycle " + scene.problem.integration.cycle,
                  in_units(simulation.macro_step(), "s"));
  const double critical = simulation.levels().front().critical_step;
  if (critical > 0)
    text += fmt::format(" ({:.3g} critical steps of the finest level)",
                        simulation.macro_step() / critical);
  if (choice)
    text += fmt::format("; chosen for the error class {} ({:.3g} % of displacement)",
                        choice->error_class, 100 * choice->allowed);
  return text;
}

template <class B>
void show_live(const Scene& scene, Simulation<B>& simulation, const LiveOptions& options,
               const ExternalForces<B>& forces) {
  if constexpr (!B::on_host) throw InputError("a live view needs a back end on the host");
  if (!scene.problem.cuts.empty() || !simulation.twins().empty())
    throw InputError(
        "cuts: a live view shows a body that stays whole; expected a scene without cuts, or plica "
        "run");
  if (scene.problem.body.following)
    throw InputError(
        "body.levels.0.refine.follows: a live view shows one mesh; expected a part that stays, "
        "such as sphere, or plica run");
  LiveView<B>(scene, simulation, options, forces).run();
}

#define PLICA_INSTANTIATE(Real, Exec)                                                         \
  template void show_live(const Scene&, Simulation<Backend<Real, Exec>>&, const LiveOptions&, \
                          const ExternalForces<Backend<Real, Exec>>&);                        \
  template std::string live_method(const Scene&, const Simulation<Backend<Real, Exec>>&,      \
                                   const std::optional<CycleChoice>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica::app
