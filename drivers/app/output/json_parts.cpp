// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <plica/core/backend.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/version.hpp>
#include <set>
#include <thread>

namespace plica::app {

using Json = nlohmann::ordered_json;

std::string material_text(const MaterialInfo& info, const MaterialOptions& material) {
  std::string text(info.name);
  const std::vector<double> values = parameter_values(info, material, {});
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    const MaterialParameter& p = info.parameters[i];
    const std::string unit = unit_of(p.kind.dimension);
    const bool takes_prefix = !unit.empty() && unit.find_first_of("/^ ") == std::string::npos;
    text += fmt::format(", {} {}", p.name,
                        takes_prefix ? in_units(values[i], unit) : p.kind.to_text(values[i]));
  }
  return text + fmt::format(", density {:g} kg/m^3", material.density);
}

Json material_json(const MaterialInfo& info, const MaterialOptions& material) {
  Json json = {{"model", info.name}};
  const std::vector<double> values = parameter_values(info, material, {});
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    json[info.parameters[i].name] = values[i];
  json["density"] = material.density;
  return json;
}

namespace {

Json point(const Point& p) { return {p.x(), p.y(), p.z()}; }
Json json_of(const Point& p) { return point(p); }
template <class T>
Json json_of(const T& value) {
  return value;
}

template <class Options>
Json shape_json(Options o) {
  Json values = Json::object();
  keys::for_each_key(o, [&](const char* key, const auto& member, const auto&, const char*) {
    values[key] = json_of(member);
  });
  return values;
}
Json shape_json(const SurfaceOptions& o) {
  const Box box = bounding_box(o.surface.vertices);
  return {
      {"triangles", o.surface.triangles.size()}, {"min", point(box.min)}, {"max", point(box.max)}};
}

struct AddMotion {
  Json& entry;
  void operator()(const SteadyMotion& o) const { entry["velocity"] = point(o.velocity); }
  void operator()(const SineMotion& o) const {
    entry["sine"] = {
        {"amplitude", point(o.amplitude)}, {"frequency", o.frequency}, {"phase", o.phase}};
  }
  void operator()(const PathMotion& o) const {
    entry["path"] = Json::array();
    for (const auto& knot : o.knots)
      entry["path"].push_back({{"time", knot.time}, {"displacement", point(knot.displacement)}});
  }
  void operator()(const SteadyTurn& o) const { entry["angular_velocity"] = o.angular_velocity; }
  void operator()(const SineTurn& o) const {
    entry["sine"] = {{"amplitude", o.amplitude}, {"frequency", o.frequency}, {"phase", o.phase}};
  }
  void operator()(const PathTurn& o) const {
    entry["path"] = Json::array();
    for (const auto& knot : o.knots)
      entry["path"].push_back({{"time", knot.time}, {"angle", knot.angle}});
  }
};

}  // namespace

Json obstacles_json(const ContactOptions& contact) {
  Json list = Json::array();
  for (std::size_t i = 0; i < contact.obstacles.size(); ++i) {
    const ObstacleOptions& obstacle = contact.obstacles[i];
    Json entry = {{"name", obstacle_name(contact, i)}};
    visit_shape(obstacle.shape,
                [&](auto shape, const auto& o) { entry[decltype(shape)::name] = shape_json(o); });
    entry["friction"] = obstacle.friction.value_or(0);
    std::visit(AddMotion{entry}, obstacle.motion);
    if (const auto& turn = obstacle.turn) {
      Json& own = entry["turn"] = {{"axis", point(turn->axis.normalized())},
                                   {"about", point(turned_about(obstacle))}};
      own["rotation"] = point(turn->rotation);
      std::visit(AddMotion{own}, turn->angle);
    }
    list.push_back(entry);
  }
  return list;
}

namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name"))
      return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown";
}

}  // namespace

StudyMachine this_machine() {
  using Exec = Kokkos::DefaultExecutionSpace;
  return {processor(), static_cast<int>(std::thread::hardware_concurrency()), Exec::name(),
          Exec().concurrency()};
}

std::string version_text() {
  std::set<std::string> backends;
#define PLICA_NAME(real, exec) backends.insert(exec::name());
  PLICA_FOR_EACH_BACKEND(PLICA_NAME)
#undef PLICA_NAME
  const std::string kokkos = fmt::format(
      "{}.{}.{}; back ends {}; default {}", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100,
      KOKKOS_VERSION % 100, fmt::join(backends, ", "), Kokkos::DefaultExecutionSpace::name());
  return text_table(
      {{"plica", version()}, {"Kokkos", kokkos}, {"compiler", compiler()}, {"git", git_revision()}},
      "<<", "");
}

nlohmann::ordered_json machine_json(const StudyMachine& machine) {
  return {{"cpu", machine.cpu},
          {"cores", machine.cores},
          {"backend", machine.backend},
          {"threads", machine.threads},
          {"compiler", compiler()},
          {"version", version()},
          {"git_revision", git_revision()}};
}

}  // namespace plica::app
