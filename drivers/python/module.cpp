// SPDX-License-Identifier: BSD-3-Clause
// Module plica._plica: a thin binding of the C++ library. Users see the Python package plica, which
// wraps it.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/commands/explain.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/output/study_table.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/program.hpp>
#include <plica/drivers/app/report/report.hpp>
#include <plica/drivers/app/scene/key_list.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/older_keys.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/python/any_simulation.hpp>
#include <plica/drivers/python/bind_results.hpp>
#include <plica/drivers/python/handle.hpp>
#include <plica/drivers/python/kokkos_session.hpp>
#include <plica/drivers/python/read_motion.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/version.hpp>

namespace nb = nanobind;
using namespace nb::literals;

namespace plica::python {
namespace {

template <class T>
using Table = nb::ndarray<const T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using ScenePtr = std::shared_ptr<app::Scene>;

/// Returns values as a numpy array without a copy; the array keeps the memory alive.
template <class T>
nb::object array(std::shared_ptr<std::vector<T>> values, std::size_t columns = 0) {
  T* data = values->data();
  const std::size_t size = values->size(), shape[] = {columns > 0 ? size / columns : size, columns};
  const nb::capsule owner(
      new std::shared_ptr<std::vector<T>>(std::move(values)),
      [](void* p) noexcept { delete static_cast<std::shared_ptr<std::vector<T>>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, T>(data, columns > 0 ? 2 : 1, shape, owner));
}
template <class T>
nb::object array(std::vector<T> values, std::size_t columns = 0) {
  return array(std::make_shared<std::vector<T>>(std::move(values)), columns);
}
nb::object array(const std::vector<Point>& points) {
  Values values;
  for (const Point& p : points) values.insert(values.end(), p.data(), p.data() + 3);
  return array(std::move(values), 3);
}
template <std::size_t corners>
nb::object array(const std::vector<std::array<int, corners>>& cells) {
  std::vector<int> values;
  for (const auto& cell : cells) values.insert(values.end(), cell.begin(), cell.end());
  return array(std::move(values), corners);
}

nb::object vector_of(const Point& p) { return array(Values{p.x(), p.y(), p.z()}); }
Values values_of(const Table<double>& table) { return {table.data(), table.data() + table.size()}; }
std::vector<Point> points_of(const Table<double>& table) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < table.shape(0); ++i)
    points.emplace_back(table(i, 0), table(i, 1), table(i, 2));
  return points;
}

// Returns the members of a mesh as a tuple, in the order of plica.Mesh
nb::tuple parts_of(const TetMesh& mesh) {
  nb::dict sets;
  for (const auto& [name, vertices] : mesh.vertex_sets) sets[name.c_str()] = array(vertices);
  nb::dict vectors, triangles;
  for (const auto& [name, all] : mesh.tet_vectors) vectors[name.c_str()] = array(all);
  for (const auto& [name, all] : mesh.triangle_sets) triangles[name.c_str()] = array(all);
  return nb::make_tuple(array(mesh.vertices), array(mesh.tets), array(mesh.region),
                        mesh.region_names, sets, array(mesh.filled), vectors, triangles);
}

void write_mesh_file(const std::string& file, const Table<double>& points, const Table<int>& tets,
                     const std::vector<int>& region, const std::vector<std::string>& region_names,
                     const std::map<std::string, std::vector<int>>& vertex_sets,
                     const std::vector<double>& filled,
                     const std::map<std::string, std::vector<std::array<double, 3>>>& tet_vectors,
                     const std::map<std::string, std::vector<std::array<int, 3>>>& triangle_sets) {
  TetMesh mesh{points_of(points), {}, region, region_names, vertex_sets};
  mesh.filled = filled, mesh.triangle_sets = triangle_sets;
  for (const auto& [name, vectors] : tet_vectors)
    for (const auto& [x, y, z] : vectors) mesh.tet_vectors[name].emplace_back(x, y, z);
  for (std::size_t i = 0; i < tets.shape(0); ++i)
    mesh.tets.push_back({tets(i, 0), tets(i, 1), tets(i, 2), tets(i, 3)});
  app::write_files(write_mesh(file, mesh).files);
}

ScenePtr load(const std::string& file, const std::string& json, const std::string& name,
              const std::vector<std::pair<std::string, std::string>>& overrides) {
  app::Tree tree =
      file.empty() ? app::tree_of(nlohmann::ordered_json::parse(json), name) : app::read_tree(file);
  for (const auto& [path, value] : overrides)
    app::set_value(tree, path + "=" + value, path + "=" + value);
  return std::make_shared<app::Scene>(app::load_scene(tree));
}

// Runs a study and returns its study.csv
std::string study_of(const ScenePtr& scene, std::optional<double> budget) {
  const Access access;
  start_kokkos();
  StudyOptions options = scene->study;
  options.duration = scene->duration, options.probes = scene->output.probes,
  options.budget = budget;
  Signals signals;
  const nb::gil_scoped_release release;
  try {
    const StudyResult result =
        study(scene->problem, options, [&](const StudyProgress&) { return signals(), true; });
    return app::study_csv(result.rows);
  } catch (const InputError& error) {
    throw app::located(error, scene->source);
  }
}

// Sets the scene up, and returns what tell(scene, precision) says of it
std::string told(const ScenePtr& scene, const std::string& precision,
                 std::string (*tell)(const app::Scene&, const std::string&)) {
  const Access access;
  start_kokkos();
  Signals signals;
  const nb::gil_scoped_release release;
  const BetweenKernels between([&] { signals(), Access::stop_at_end(); });
  return tell(*scene, precision);
}

// Runs the program plica with these words of a command line, and returns its exit status
int run_program(std::vector<std::string> words) {
  if (Kokkos::is_initialized())
    throw std::runtime_error("the program starts Kokkos, which runs here already");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const nb::gil_scoped_release release;
  return app::program(static_cast<int>(words.size()), pointers.data());
}

void bind_scene(nb::module_& m) {
  nb::class_<app::Scene>(m, "Scene")
      .def_ro("file", &app::Scene::file)
      .def_ro("name", &app::Scene::name)
      .def_ro("duration", &app::Scene::duration)
      .def_ro("warnings", &app::Scene::warnings)
      .def_prop_ro("cycle", [](const app::Scene& s) { return s.problem.integration.cycle; })
      .def_prop_ro("automatic_step",
                   [](const app::Scene& s) { return !s.problem.integration.macro_step; })
      .def_prop_ro("levels", [](const app::Scene& s) { return s.problem.body.levels.size(); })
      .def_prop_ro("placement",
                   [](const app::Scene& s) {
                     const Point shift = placement_of(s.problem.body);
                     return nb::make_tuple(shift.x(), shift.y(), shift.z());
                   })
      .def("mesh",
           [](const app::Scene& s, std::size_t level) {
             if (level >= s.problem.body.levels.size())
               throw InputError("level: there is no level " + std::to_string(level) +
                                "; the scene has " + std::to_string(s.problem.body.levels.size()) +
                                ", counted from 0, the finest");
             return parts_of(app::in_input_order(s.problem.body.levels[level], s.numbering[level]));
           })
      .def("rows",
           [](const app::Scene& s, std::size_t level) {
             const app::Numbering& numbering = s.numbering.at(level);
             const std::string file = level < s.levels.size() ? s.levels[level].file : "";
             return nb::make_tuple(
                 file, array(app::in_input_order(numbering.vertex_ids, numbering.input.vertices)));
           })
      .def("surface",
           [](const app::Scene& s) {
             const auto& surface = s.problem.body.surface;
             return surface ? array(surface->triangles) : nb::none();
           })
      .def("texture", [](const app::Scene& s) {
        Values values;
        if (const auto& surface = s.problem.body.surface)
          for (const CornerTexture& corners : surface->texture)
            for (const auto& uv : corners) values.insert(values.end(), uv.begin(), uv.end());
        return array(std::move(values));
      });
  m.def("load", &load, "file"_a, "json"_a, "name"_a, "overrides"_a);
  m.def("study", &study_of, "scene"_a, "budget"_a.none());
  m.def("explain", [](const ScenePtr& scene, const std::string& precision) {
    return told(scene, precision, app::explained);
  });
  m.def("check", [](const ScenePtr& scene, const std::string& precision) {
    return told(scene, precision, app::checked_json);
  });
}

nb::object live(const Handle& simulation, Field field, int level) {
  return array(simulation->live(field, level), 3);
}

void set_forces(const Handle& simulation, const nb::object& callback) {
  if (callback.is_none()) return simulation->set_forces({});
  const auto held = std::shared_ptr<nb::object>(new nb::object(callback), [](nb::object* object) {
    const nb::gil_scoped_acquire gil;  // the thread that drops the callback may lack the GIL
    delete object;
  });
  simulation->set_forces([held](int level, double time, const Values& x, const Values& v,
                                Values& f) {
    const nb::gil_scoped_acquire gil;
    const auto forces = std::make_shared<Values>(f);
    (*held)(level, time, array(Values(x), 3), array(Values(v), 3), array(forces, 3));
    if (const auto bad =
            std::ranges::find_if_not(*forces, [](double force) { return std::isfinite(force); });
        bad != forces->end())
      throw InputError("forces: level " + std::to_string(level) + ", vertex " +
                       std::to_string((bad - forces->begin()) / 3) + ": " + std::to_string(*bad) +
                       "; expected finite numbers [N]");
    f = *forces;
  });
}

/// Serves a live view until Ctrl-C, which raises KeyboardInterrupt. Calls listening(address) once.
void show_live(const Handle& simulation, const app::Port& port, const nb::object& listening) {
  const Handle::Use used = simulation.use();
  Signals signals;
  const nb::gil_scoped_release release;
  app::LiveOptions options{port};
  options.listening = [&](const std::string& address) {
    const nb::gil_scoped_acquire gil;
    listening(address);
  };
  options.ended = [&] { return signals(), Access::offer(), false; };
  used->show_live(options);
}

void bind_simulation(nb::module_& m) {
  using H = Handle;
  nb::class_<app::Port>(m, "Port").def(nb::init<int>());
  nb::class_<H>(m, "Simulation")
      .def("close", &H::close)
      .def("advance",
           [](const H& s, double until, long at_most) {
             const Handle::Use used = s.use();
             Signals signals;
             const nb::gil_scoped_release release;
             const BetweenKernels between([&] { signals(), Access::stop_at_end(); });
             return used->advance(until, at_most, [&] { signals(), Access::offer(); });
           })
      .def("end_at", [](const H& s, double time) { s->end_at(time); })
      .def("positions", [](const H& s, int level) { return live(s, Field::positions, level); })
      .def("velocities", [](const H& s, int level) { return live(s, Field::velocities, level); })
      .def("surface_positions", [](const H& s) { return live(s, Field::surface_positions, 0); })
      .def("surface_velocities", [](const H& s) { return live(s, Field::surface_velocities, 0); })
      .def("surface_normals", [](const H& s) { return live(s, Field::surface_normals, 0); })
      .def("element_fields",
           [](const H& s, int level) {
             ElementFields fields = s->element_fields(level, false);
             return nb::make_tuple(fields.per_vertex, array(std::move(fields.von_mises)),
                                   array(std::move(fields.J)));
           })
      .def("tensor_fields",
           [](const H& s, int level) {
             ElementFields fields = s->element_fields(level, true);
             return nb::make_tuple(array(std::move(fields.stress), 6),
                                   array(std::move(fields.pressure)),
                                   array(std::move(fields.principal_stretches), 3));
           })
      .def("contact_pressure", [](const H& s) { return array(s->contact_pressure()); })
      .def("wrenches",
           [](const H& s) {
             std::vector<nb::object> all;
             for (const Wrench& w : s->wrenches())
               all.push_back(nb::make_tuple(w.obstacle, vector_of(w.force), vector_of(w.torque)));
             return all;
           })
      .def("reactions",
           [](const H& s) {
             std::vector<nb::object> all;
             for (const Reaction& r : s->reactions())
               all.push_back(nb::make_tuple(r.set, vector_of(r.force), vector_of(r.torque),
                                            vector_of(r.about)));
             return all;
           })
      .def("contact_depths", [](const H& s) { return s->contact_depths(); })
      .def("tools",
           [](const H& s) {
             std::vector<nb::object> all;
             for (const ToolState& t : s->tools())
               all.push_back(nb::make_tuple(t.obstacle, vector_of(t.displacement),
                                            vector_of(t.velocity), vector_of(t.rotation),
                                            vector_of(t.angular_velocity)));
             return all;
           })
      .def("held",
           [](const H& s) {
             std::vector<nb::object> all;
             for (const HeldBy& h : s->held()) all.push_back(nb::make_tuple(h.obstacle, h.points));
             return all;
           })
      .def("grasp", [](const H& s, int obstacle) { s->grasp(obstacle); })
      .def("release", [](const H& s, int obstacle) { s->release(obstacle); })
      .def("cavities",
           [](const H& s) {
             std::vector<nb::object> all;
             for (const CavityState& c : s->cavities())
               all.push_back(nb::make_tuple(c.load, c.volume, c.pressure));
             return all;
           })
      .def(
          "move_obstacle",
          [](const H& s, int obstacle, const std::array<double, 3>& d,
             const std::optional<std::array<double, 3>>& r) {
            const auto point = [](const std::array<double, 3>& p) {
              return Point(p[0], p[1], p[2]);
            };
            s->move_obstacle(obstacle, point(d),
                             r ? std::optional<Point>(point(*r)) : std::nullopt);
          },
          "obstacle"_a, "displacement"_a, "rotation"_a.none())
      .def("set_obstacle_motion",
           [](const H& s, int obstacle, const std::string& motion, const std::string& turn) {
             s->set_obstacle_motion(
                 obstacle, motion.empty() ? std::nullopt : std::optional(read_motion(motion)),
                 turn.empty() ? std::nullopt : std::optional(read_turn(turn)));
           })
      .def("obstacles",
           [](const H& s) {
             std::vector<nb::object> all;
             for (const ObstaclePlace& o : s->obstacles())
               all.push_back(nb::make_tuple(o.name, vector_of(o.displacement),
                                            vector_of(o.rotation), vector_of(o.origin)));
             return all;
           })
      .def("cut",
           [](const H& s, const std::vector<std::array<double, 9>>& triangles) {
             Blade blade;
             for (const auto& t : triangles)
               blade.push_back({Point(&t[0]), Point(&t[3]), Point(&t[6])});
             const CutReport report = s->cut(blade);
             return nb::make_tuple(report.opened_faces, report.new_vertices, report.pieces,
                                   report.seconds);
           })
      .def("set_gravity",
           [](const H& s, const std::array<double, 3>& g) {
             s->set_gravity({g[0], g[1], g[2]});
           })
      .def("set_time", [](const H& s, double time) { s->set_time(time); })
      .def("reset", [](const H& s) { s->reset(); })
      .def("start_files", [](const H& s, const std::string& folder) { s->start_files(folder); })
      .def(
          "write_frame",
          [](const H& s, const std::string& status, const std::optional<Diagnosis>& diagnosis) {
            s->write_frame(status, diagnosis);
          },
          "status"_a, "diagnosis"_a.none())
      .def("show_live", &show_live)
      .def("set_state", [](const H& s, const Table<double>& x,
                           const Table<double>& v) { s->set_state(values_of(x), values_of(v)); })
      .def("set_forces", &set_forces, nb::arg("callback").none())
      .def("save",
           [](const H& s) {
             const SavedState saved = s->save();
             return nb::bytes(saved.bytes.data(), saved.bytes.size());
           })
      .def("restore",
           [](const H& s, const nb::object& given) {
             nb::bytes saved;
             if (!nb::try_cast(given, saved))
               throw InputError("restore: expected the bytes that save() has returned");
             const auto* bytes = static_cast<const unsigned char*>(saved.data());
             s->restore({{bytes, bytes + saved.size()}});
           })
      .def_prop_ro("time", [](const H& s) { return s->time(); })
      .def_prop_ro("macro_step", [](const H& s) { return s->macro_step(); })
      .def_prop_ro("macro_steps", [](const H& s) { return s->macro_steps(); })
      .def_prop_ro("precision", [](const H& s) { return s->precision(); })
      .def_prop_ro("energies", [](const H& s) { return s->energies(); })
      .def_prop_ro("counters", [](const H& s) { return s->counters(); })
      .def_prop_ro("residual", [](const H& s) { return s->residual(); })
      .def_prop_ro("levels", [](const H& s) { return app::levels_json(s->levels()).dump(); });
  m.def("simulate", [](const ScenePtr& scene, const std::string& precision) {
    const Access access;
    start_kokkos();
    Signals signals;
    const nb::gil_scoped_release release;
    const BetweenKernels between([&] { signals(), Access::stop_at_end(); });
    return Handle(make_simulation(scene, precision));
  });
}

nb::dict info() {
  const Access access;
  const KokkosInfo kokkos = kokkos_info();
  nb::dict all;
  all["version"] = version(), all["revision"] = git_revision(), all["compiler"] = compiler();
  all["kokkos"] = kokkos.version, all["backend"] = kokkos.backend, all["threads"] = kokkos.threads;
  return all;
}

}  // namespace

NB_MODULE(_plica, m) {
  nb::set_leak_warnings(false);  // a simulation in a global variable lives longer than the module
  nb::exception<InputError>(m, "InputError", PyExc_ValueError).attr("__module__") = "plica";
  nb::exception<app::FileError>(m, "FileError", PyExc_OSError).attr("__module__") = "plica";
  m.def("start", [](int threads) {
    const Access access;
    start_kokkos(threads);
  });
  m.def("end", &Access::end);
  m.def("after_fork", &Access::after_fork);
  m.def("finalize", [] {
    if (!Access::lost_by_fork()) finalize_kokkos();
  });
  m.def("program", &run_program);
  m.def("info", &info);
  m.def("version", [] { return std::string(version()); });
  m.def("keys", [] {
    std::vector<std::vector<std::string>> rows;
    for (const app::KeyInfo& key : app::scene_keys())
      rows.push_back({key.path, key.type_text, key.otherwise, key.help});
    return rows;
  });
  m.def("parse_every", [](const std::string& name, const std::string& text) {
    try {
      const app::Interval interval = app::parse_interval(text);
      return std::pair(interval.time, interval.steps);
    } catch (const std::invalid_argument& problem) {
      throw InputError(name + ": expected a time such as '20 ms'" +
                       (name == "every" ? " or macro steps such as '10 steps'" : "") + ", got '" +
                       text + "', " + problem.what());
    }
  });
  m.def("read_mesh", [](const std::string& file, const std::string& regions,
                        const std::vector<std::string>& leave_out, const std::string& order) {
    const ReadOptions options = {Flaws::refused, regions, leave_out, second_order_named(order)};
    return parts_of(read_mesh(file, nullptr, options));
  });
  m.def("write_mesh", &write_mesh_file, "file"_a, "points"_a, "tets"_a, "region"_a,
        "region_names"_a, "vertex_sets"_a, "filled"_a, "tet_vectors"_a, "triangle_sets"_a);
  m.def("former_run", [](const std::string& folder) { return app::former_run(folder); });
  m.def("report", [](const std::string& folder, std::size_t frames) {
    const app::Report made = app::make_report(folder, frames);
    const auto file = (std::filesystem::path(folder) / "report.html").string();
    app::write_file(file, made.html);
    return nb::make_tuple(file, made.warnings);
  });
  bind_results(m);
  bind_scene(m);
  bind_simulation(m);
}

}  // namespace plica::python
