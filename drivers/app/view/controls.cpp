// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <plica/core/error.hpp>
#include <plica/drivers/app/view/controls.hpp>

namespace plica::app {
namespace {

using ControlJson = nlohmann::json;

double number_of(const ControlJson& from, const char* name, double above, double most) {
  const auto found = from.is_object() ? from.find(name) : from.end();
  const double value = found != from.end() && found->is_number() ? found->get<double>() : NAN;
  if (!(value >= above && value <= most))
    throw InputError(std::string(name) + ": expected a number from " + std::to_string(above) +
                     " to " + std::to_string(most) + ", got " +
                     (found == from.end() ? "nothing" : found->dump()));
  return value;
}

Point point_in(const ControlJson& from, const char* name) {
  const auto found = from.find(name);
  if (found == from.end() || !found->is_array() || found->size() != 3 ||
      !std::ranges::all_of(*found, [](const ControlJson& x) { return x.is_number(); }))
    throw InputError(std::string(name) + ": expected three numbers, got " +
                     (found == from.end() ? "nothing" : found->dump()));
  return {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
}

// Returns a member that is an object; null: there is none, or it is null
const ControlJson* object_in(const ControlJson& from, const char* name) {
  const auto found = from.find(name);
  return found != from.end() && found->is_object() ? &*found : nullptr;
}

}  // namespace

Controls controls_of(const std::string& text) {
  const ControlJson said = ControlJson::parse(text, nullptr, false);
  if (!said.is_object()) throw InputError("expected an object in JSON");
  Controls c;
  c.running = said.value("running", ControlJson(true)) == ControlJson(true);
  c.restarts = static_cast<int>(number_of(said, "restarts", 0, 1e9));
  c.speed = number_of(said, "speed", 1e-6, 1e3);
  c.gravity = number_of(said, "gravity", -1e4, 1e4);
  c.stiffness = number_of(said, "stiffness", 0, 1e12);
  if (const auto colour = said.find("colour"); colour != said.end() && colour->is_string())
    c.colour = *colour;
  if (const ControlJson* pull = object_in(said, "pull"))
    c.pull = {point_in(*pull, "at"), point_in(*pull, "target")};
  if (const ControlJson* tool = object_in(said, "tool"))
    c.tool = {point_in(*tool, "centre"),
              number_of(*tool, "radius", std::numeric_limits<double>::min(), 1e6)};
  if (const auto moved = said.find("moved"); moved != said.end() && moved->is_array())
    for (const ControlJson& one : *moved)
      c.moved.push_back(
          {static_cast<int>(number_of(one, "obstacle", 0, 1e6)), point_in(one, "displacement")});
  return c;
}

}  // namespace plica::app
