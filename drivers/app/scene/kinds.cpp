// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <plica/drivers/app/scene/kinds.hpp>
#include <stdexcept>

namespace plica::app {

void Value::error(const std::string& message) const { throw InputError(path + ": " + message, tree.where); }

void Value::mismatch(const std::string& expected, const std::string& remark) const {
  error("expected " + expected + ", got " + tree.shown() + (remark.empty() ? "" : ", " + remark));
}

const std::string& Value::scalar(const std::string& expected) const {
  if (tree.kind != Tree::Kind::scalar) mismatch(expected);
  return tree.text;
}

const std::vector<Tree>& Value::list(const std::string& expected, std::size_t size) const {
  if (tree.kind != Tree::Kind::list || (size > 0 && tree.items.size() != size)) mismatch(expected);
  return tree.items;
}

Value Value::item(std::size_t index) const { return {tree.items[index], fmt::format("{}.{}", path, index)}; }

bool Bounds::contains(double value) const {
  return (min_excluded ? value > min : value >= min) && (max_excluded ? value < max : value <= max);
}

std::string Bounds::text(const std::string& unit) const {
  const std::string space = unit.empty() ? "" : " ";
  if (max < std::numeric_limits<double>::infinity())
    return fmt::format("in {}{:g}, {:g}{}{}{}", min_excluded ? "(" : "[", min, max, max_excluded ? ")" : "]", space,
                       unit);
  if (min > -std::numeric_limits<double>::infinity())
    return fmt::format("{} {:g}{}{}", min_excluded ? ">" : ">=", min, min == 0 ? "" : space, min == 0 ? "" : unit);
  return {};
}

namespace {

std::string in_words(const Dimension& dimension, const Bounds& range) {
  const std::string unit = unit_of(dimension), bounds = range.text(unit);
  return (unit.empty() ? "" : " (" + unit + ")") + (bounds.empty() ? "" : " " + bounds);
}

std::string with_unit(const std::string& text, const Dimension& dimension) {
  const std::string unit = unit_of(dimension);
  return unit.empty() ? text : text + " " + unit;
}

template <class Values>
std::string listed(const Values& values) {
  return values.size() == 1 ? fmt::format("{}", *values.begin()) : fmt::format("[{}]", fmt::join(values, ", "));
}

template <class Kind, class T>
void read_per_level(const Value& value, const Kind& kind, const std::string& expected, std::vector<T>& target) {
  if (value.tree.kind == Tree::Kind::scalar) {
    target.resize(1);
    return kind.read(value, target[0]);
  }
  target.resize(value.list(expected).size());
  if (target.empty()) value.mismatch(expected);
  for (std::size_t i = 0; i < target.size(); ++i) kind.read(value.item(i), target[i]);
}

}  // namespace

void Quantity::read(const Value& value, double& target) const { read(value, target, expects()); }

void Quantity::read(const Value& value, double& target, const std::string& expected) const {
  Measured measured;
  try {
    measured = measure(value.scalar(expected));
  } catch (const std::invalid_argument& problem) {
    value.mismatch(expected, problem.what());
  }
  if (measured.dimension.value_or(dimension) != dimension) value.mismatch(expected, name_of(*measured.dimension));
  if (!range.contains(measured.value)) value.mismatch(expected);
  target = measured.value;
}

std::string Quantity::expects() const { return name_of(dimension) + in_words(dimension, range); }

std::string Quantity::shown(double value) const { return with_unit(fmt::format("{:g}", value), dimension); }

void AutoQuantity::read(const Value& value, std::optional<double>& target) const {
  if (value.tree.kind == Tree::Kind::scalar && value.tree.text == "auto") {
    target.reset();
  } else {
    quantity.read(value, target.emplace(), expects());
  }
}

void Vector::read(const Value& value, Point& target) const {
  value.list(expects(), 3);
  for (int axis = 0; axis < 3; ++axis) {
    double component = 0;
    Quantity{dimension, range}.read(value.item(static_cast<std::size_t>(axis)), component);
    target[axis] = component;
  }
}

std::string Vector::expects() const { return "a list of 3 " + plural_of(dimension) + in_words(dimension, range); }

std::string Vector::shown(const Point& value) const {
  return with_unit(fmt::format("[{:g}, {:g}, {:g}]", value.x(), value.y(), value.z()), dimension);
}

void Count::read(const Value& value, int& target) const {
  const std::string& text = value.scalar(expects());
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), target);
  if (error != std::errc{} || rest != text.data() + text.size() || target < min) value.mismatch(expects());
}

void AutoCount::read(const Value& value, int& target) const {
  target = 0;
  if (value.scalar(expects()) != "auto") Count{1}.read(value, target);
}

void Counts::read(const Value& value, std::array<int, 3>& target) const {
  value.list(expects(), 3);
  for (std::size_t i = 0; i < 3; ++i) Count{min}.read(value.item(i), target[i]);
}

std::string Counts::shown(const std::array<int, 3>& value) const { return listed(value); }

void Flag::read(const Value& value, bool& target) const {
  const std::string& text = value.scalar(expects());
  if (text != "true" && text != "false") value.mismatch(expects());
  target = text == "true";
}

void Text::read(const Value& value, std::string& target) const {
  target = value.scalar(expects());
  if (target.empty()) value.mismatch(expects());
}

void Name::read(const Value& value, std::string& target) const {
  const std::string& text = value.scalar(expects());
  const std::vector<std::string> known = names(choices());
  if (std::ranges::find(known, text) == known.end()) value.error(unknown_name(family, text, known));
  target = text;
}

std::string Name::expects() const { return fmt::format("{}", fmt::join(names(choices()), " | ")); }

void NamePerLevel::read(const Value& value, std::vector<std::string>& target) const {
  read_per_level(value, name, expects(), target);
}

std::string NamePerLevel::shown(const std::vector<std::string>& value) const { return listed(value); }

void AutoCountPerLevel::read(const Value& value, std::vector<int>& target) const {
  read_per_level(value, AutoCount{}, expects(), target);
}

std::string AutoCountPerLevel::shown(const std::vector<int>& value) const {
  std::vector<std::string> words;
  for (const int count : value) words.push_back(AutoCount{}.shown(count));
  return listed(words);
}

void Shares::read(const Value& value, const Target& target) const {
  if (value.tree.kind != Tree::Kind::list) {
    name.read(value, target.rule);
  } else {
    target.rule = "custom";
    target.shares.resize(value.list(expects()).size());
    for (std::size_t i = 0; i < target.shares.size(); ++i)
      Quantity{number, not_negative}.read(value.item(i), target.shares[i]);
  }
}

void Every::read(const Value& value, Interval& target) const {
  try {
    target = parse_interval(value.scalar(expects()));
  } catch (const std::invalid_argument& problem) {
    value.mismatch(expects(), problem.what());
  }
}

void LevelChoice::read(const Value& value, VolumeLevels& target) const {
  target = {};
  if (value.tree.kind == Tree::Kind::list) {
    for (std::size_t i = 0; i < value.tree.items.size(); ++i) {
      const Value item = value.item(i);
      Count{0}.read(item, target.levels.emplace_back());
      if (std::ranges::count(target.levels, target.levels.back()) > 1) item.error("this level is in the list already");
    }
    if (target.levels.empty()) value.mismatch(expects());
  } else if (value.scalar(expects()) == "all") {
    target.all = true;
  } else if (value.tree.text == "true") {
    target.levels = {0};
  } else if (value.tree.text != "false") {
    value.mismatch(expects());
  }
}

std::string LevelChoice::shown(const VolumeLevels& value) const {
  return value.all ? "all" : value.levels.empty() ? "false" : fmt::format("[{}]", fmt::join(value.levels, ", "));
}

void NamedPoints::read(const Value& value, std::map<std::string, Point>& target) const {
  if (value.tree.kind != Tree::Kind::map || value.tree.items.empty()) value.mismatch(expects());
  for (const Tree& item : value.tree.items) {
    const Value named{item, value.path + "." + item.key};
    const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
    if (item.key.empty() || !std::ranges::all_of(item.key, plain))
      throw InputError(fmt::format("{}: expected a name of letters, digits, _ and -, got '{}'", value.path, item.key),
                       item.key_where);
    Vector{length}.read(named, target[item.key]);
  }
}

}  // namespace plica::app
