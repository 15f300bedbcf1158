// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/core/text.hpp>

namespace plica {

std::vector<std::string> names(const std::vector<Choice>& choices) {
  std::vector<std::string> list;
  for (const Choice& choice : choices) list.push_back(choice.name);
  return list;
}

}  // namespace plica

namespace plica::keys {
namespace {

struct Named {
  Dimension dimension;
  const char* name;
  const char* plural;
  const char* unit;
};
constexpr std::array named_dimensions = {
    Named{plain, "a number", "numbers", ""},
    Named{length, "a length", "lengths", "m"},
    Named{duration, "a time", "times", "s"},
    Named{rate, "a rate", "rates", "1/s"},
    Named{velocity, "a velocity", "velocities", "m/s"},
    Named{acceleration, "an acceleration", "accelerations", "m/s^2"},
    Named{angular_velocity, "an angular velocity", "angular velocities", "rad/s"},
    Named{pressure, "a pressure", "pressures", "Pa"},
    Named{density, "a density", "densities", "kg/m^3"},
    Named{angle, "an angle", "angles", "rad"},
    Named{{.mass = 1}, "a mass", "masses", "kg"},
    Named{{.length = 2}, "an area", "areas", "m^2"},
    Named{{.length = 3}, "a volume", "volumes", "m^3"},
    Named{force, "a force", "forces", "N"},
    Named{{.mass = 1, .time = -2}, "a stiffness", "stiffnesses", "N/m"},
    Named{{.mass = 1, .time = -1}, "a damping", "dampings", "kg/s"},
    Named{{.mass = 1, .length = 2, .time = -2}, "an energy", "energies", "J"}};

const Named* find_name(const Dimension& dimension) {
  const auto found = std::ranges::find(named_dimensions, dimension, &Named::dimension);
  return found == named_dimensions.end() ? nullptr : &*found;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string in_words(const Dimension& dimension, const Bounds& range) {
  const std::string unit = unit_of(dimension), bounds = range.text(unit);
  return (unit.empty() ? "" : " (" + unit + ")") + (bounds.empty() ? "" : " " + bounds);
}

std::string with_unit(const std::string& text, const Dimension& dimension) {
  const std::string unit = unit_of(dimension);
  return unit.empty() ? text : text + " " + unit;
}

[[noreturn]] void refuse(const std::string& path, const std::string& value,
                         const std::string& expected) {
  throw InputError(path + " is " + value + "; expected " + expected);
}

void check_number(const std::string& path, double value, const Quantity& kind,
                  const std::string& expected) {
  if (!kind.range.contains(value))
    refuse(path, kind.to_text(value, 9), expected + (std::isfinite(value) ? "" : ", finite"));
}

}  // namespace

std::string name_of(const Dimension& dimension) {
  const Named* named = find_name(dimension);
  return named != nullptr ? named->name : "a quantity in " + unit_of(dimension);
}

std::string plural_of(const Dimension& dimension) {
  const Named* named = find_name(dimension);
  return named != nullptr ? named->plural : "quantities in " + unit_of(dimension);
}

std::string unit_of(const Dimension& dimension) {
  if (const Named* named = find_name(dimension)) return named->unit;
  std::string above, below;
  const auto add = [&](const char* symbol, int exponent) {
    if (exponent == 0) return;
    std::string& text = exponent > 0 ? above : below;
    text += (exponent < 0 ? "/" : text.empty() ? "" : "*") + std::string(symbol);
    if (std::abs(exponent) > 1) text += "^" + std::to_string(std::abs(exponent));
  };
  add("kg", dimension.mass), add("m", dimension.length), add("s", dimension.time),
      add("rad", dimension.angle);
  return (above.empty() ? "1" : above) + below;
}

bool Bounds::contains(double value) const {
  return std::isfinite(value) && (min_excluded ? value > min : value >= min) &&
         (max_excluded ? value < max : value <= max);
}

std::string Bounds::text(const std::string& unit) const {
  const std::string space = unit.empty() ? "" : " ";
  if (max < std::numeric_limits<double>::infinity())
    return "in " + std::string(min_excluded ? "(" : "[") + number(min) + ", " + number(max) +
           (max_excluded ? ")" : "]") + space + unit;
  if (min > -std::numeric_limits<double>::infinity())
    return (min_excluded ? "> " : ">= ") + number(min) + (min == 0 ? "" : space + unit);
  return {};
}

std::string Quantity::type_text() const { return name_of(dimension) + in_words(dimension, range); }
std::string Quantity::to_text(double value, int digits) const {
  return with_unit(number(value, digits), dimension);
}
void Quantity::check(const std::string& path, double value) const {
  check_number(path, value, *this, type_text());
}

void AutoQuantity::check(const std::string& path, const std::optional<double>& value) const {
  if (value) check_number(path, *value, quantity, type_text());
}

std::string Vector::type_text() const {
  return "a list of 3 " + plural_of(dimension) + in_words(dimension, range);
}

std::string Vector::to_text(const Point& value) const {
  return with_unit(
      "[" + number(value.x()) + ", " + number(value.y()) + ", " + number(value.z()) + "]",
      dimension);
}

void Vector::check(const std::string& path, const Point& value) const {
  for (const double component : value)
    check_number(path, component, {dimension, range}, type_text());
}

void Direction::check(const std::string& path, const Point& value) const {
  Vector{plain}.check(path, value);
  if (value.isZero(0)) refuse(path, to_text(value), "a direction");
}

std::string Count::type_text() const {
  if (max == std::numeric_limits<int>::max()) return "a whole number >= " + std::to_string(min);
  return "a whole number in [" + std::to_string(min) + ", " + std::to_string(max) + "]";
}

void Count::check(const std::string& path, int value) const {
  if (value < min || value > max) refuse(path, to_text(value), type_text());
}

void AutoCount::check(const std::string& path, int value) const {
  if (value != automatic && (value < min || value > max)) refuse(path, to_text(value), type_text());
}

std::string Counts::to_text(const std::array<int, 3>& value) const {
  return "[" + std::to_string(value[0]) + ", " + std::to_string(value[1]) + ", " +
         std::to_string(value[2]) + "]";
}

std::string Name::type_text() const { return joined(names(choices()), " | "); }

void Name::check(const std::string& path, const std::string& value) const {
  const std::vector<std::string> known = names(choices());
  if (std::ranges::find(known, value) == known.end())
    throw InputError(path + ": " + unknown_name(family, value, known));
}

void Shares::check(const std::string& path, const Target& value) const {
  name.check(path, value.rule);
  for (const double one : value.shares) share.check(path, one);
}

}  // namespace plica::keys
