// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <plica/drivers/app/scene/key_list.hpp>
#include <plica/drivers/app/scene/reader.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/registry.hpp>
#include <stdexcept>

namespace plica::app {

void Value::error(const std::string& message) const {
  throw InputError((path.empty() ? "the scene" : path) + ": " + message, tree.where);
}

void Value::mismatch(const std::string& expected, const std::string& remark) const {
  error("expected " + expected + ", got " + tree.to_text() + (remark.empty() ? "" : ", " + remark));
}

const std::string& Value::scalar(const std::string& expected) const {
  if (tree.kind != Tree::Kind::scalar) mismatch(expected);
  return tree.text;
}

const std::vector<Tree>& Value::list(const std::string& expected, std::size_t size) const {
  if (tree.kind != Tree::Kind::list || (size > 0 && tree.items.size() != size)) mismatch(expected);
  return tree.items;
}

const std::vector<Tree>& Value::map() const {
  if (tree.kind != Tree::Kind::map) mismatch("a map of keys");
  return tree.items;
}

Value Value::item(std::size_t index) const {
  return {tree.items[index], fmt::format("{}.{}", path, index)};
}

namespace {

void read_quantity(const Value& value, const Quantity& kind, double& target,
                   const std::string& expected) {
  Measured measured;
  try {
    measured = measure(value.scalar(expected));
  } catch (const std::invalid_argument& problem) {
    value.mismatch(expected, problem.what());
  }
  if (measured.dimension.value_or(kind.dimension) != kind.dimension)
    value.mismatch(expected, name_of(*measured.dimension));
  if (!kind.range.contains(measured.value)) value.mismatch(expected);
  target = measured.value;
}

// Returns the paths where a misplaced key belongs: "body.material or body.regions.<name>". Empty:
// nowhere, or in more than two places
std::string homes_of(const std::string& key) {
  std::vector<std::string> homes;
  for (const KeyInfo& info : scene_keys()) {
    if (info.path == key) homes.emplace_back("the top level");
    if (info.path.ends_with("." + key))
      homes.push_back(info.path.substr(0, info.path.size() - key.size() - 1));
  }
  return homes.size() > 2 ? std::string{} : fmt::format("{}", fmt::join(homes, " or "));
}

}  // namespace

void read(const Value& value, const Quantity& kind, double& target) {
  read_quantity(value, kind, target, kind.type_text());
}

void read(const Value& value, const AutoQuantity& kind, std::optional<double>& target) {
  if (value.tree.kind == Tree::Kind::scalar && value.tree.text == "auto") {
    target.reset();
  } else {
    read_quantity(value, kind.quantity, target.emplace(), kind.type_text());
  }
}

void read(const Value& value, const Vector& kind, Point& target) {
  value.list(kind.type_text(), 3);
  for (int axis = 0; axis < 3; ++axis)
    read(value.item(static_cast<std::size_t>(axis)), Quantity{kind.dimension, kind.range},
         target[axis]);
}

void read(const Value& value, const Direction& kind, Point& target) {
  read(value, Vector{plain}, target);
  if (target.isZero(0)) value.error("expected a direction, got " + kind.to_text(target));
}

void read(const Value& value, const NormalOrDirection& kind, Point& target) {
  if (value.tree.kind == Tree::Kind::list) return read(value, Direction{}, target);
  if (value.scalar(kind.type_text()) != "normal") value.mismatch(kind.type_text());
  target.setZero();
}

void read(const Value& value, const Count& kind, int& target) {
  const std::string& text = value.scalar(kind.type_text());
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), target);
  if (error != std::errc{} || rest != text.data() + text.size() || target < kind.min ||
      target > kind.max)
    value.mismatch(kind.type_text());
}

void read(const Value& value, const AutoCount& kind, int& target) {
  target = kind.automatic;
  if (value.scalar(kind.type_text()) != "auto") read(value, Count{kind.min, kind.max}, target);
}

void read(const Value& value, const Counts& kind, std::array<int, 3>& target) {
  value.list(kind.type_text(), 3);
  for (std::size_t i = 0; i < 3; ++i) read(value.item(i), Count{kind.min}, target[i]);
}

void read(const Value& value, const Flag& kind, bool& target) {
  const std::string& text = value.scalar(kind.type_text());
  if (text != "true" && text != "false") value.mismatch(kind.type_text());
  target = text == "true";
}

void read(const Value& value, const Text& kind, std::string& target) {
  target = value.scalar(kind.type_text());
  if (target.empty()) value.mismatch(kind.type_text());
}

void read(const Value& value, const Name& kind, std::string& target) {
  const std::string& text = value.scalar(kind.type_text());
  const std::vector<std::string> known = names(kind.choices());
  if (std::ranges::find(known, text) == known.end())
    value.error(unknown_name(kind.family, text, known));
  target = text;
}

void read(const Value& value, const TissueName& kind, MaterialOptions& target) {
  std::string name;
  read(value, kind.name, name);
  target = tissue_material(name);
}

void read(const Value& value, const PresetName& kind, Problem& target) {
  std::string name;
  read(value, kind.name, name);
  apply_preset(name, target);
}

void read(const Value& value, const Shares& kind, const Shares::Target& target) {
  if (value.tree.kind != Tree::Kind::list) return read(value, kind.name, target.rule);
  target.rule = "custom";
  target.shares.resize(value.list(kind.type_text()).size());
  for (std::size_t i = 0; i < target.shares.size(); ++i)
    read(value.item(i), Shares::share, target.shares[i]);
}

void read(const Value& value, const Entry& kind, Entry::Map& target) {
  read(value, kind.quantity, target[kind.name]);
}

void read(const Value& value, const Every& kind, Interval& target) {
  try {
    target = parse_interval(value.scalar(kind.type_text()));
  } catch (const std::invalid_argument& problem) {
    value.mismatch(kind.type_text(), problem.what());
  }
}

void read(const Value& value, const LevelChoice& kind, VolumeLevels& target) {
  target = {};
  if (value.tree.kind == Tree::Kind::list) {
    for (std::size_t i = 0; i < value.tree.items.size(); ++i) {
      const Value item = value.item(i);
      read(item, Count{0}, target.levels.emplace_back());
      if (std::ranges::count(target.levels, target.levels.back()) > 1)
        item.error("this level is in the list already");
    }
    if (target.levels.empty()) value.mismatch(kind.type_text());
  } else if (value.scalar(kind.type_text()) == "all") {
    target.all = true;
  } else if (value.tree.text == "true") {
    target.levels = {0};
  } else if (value.tree.text != "false") {
    value.mismatch(kind.type_text());
  }
}

std::string LevelChoice::to_text(const VolumeLevels& value) const {
  return value.all              ? "all"
         : value.levels.empty() ? "false"
                                : fmt::format("[{}]", fmt::join(value.levels, ", "));
}

void read(const Value& value, const NamedPoints& kind, std::map<std::string, Point>& target) {
  if (value.tree.kind != Tree::Kind::map || value.tree.items.empty())
    value.mismatch(kind.type_text());
  for (const Tree& item : value.tree.items) {
    const auto plain = [](unsigned char c) {
      return std::isalnum(c) != 0 || c == '_' || c == '-' || c >= 0x80;
    };  // letters beyond ASCII are UTF-8
    if (item.key.empty() || !std::ranges::all_of(item.key, plain))
      throw InputError(fmt::format("{}: expected a name of letters, digits, _ and -, got '{}'",
                                   value.path, item.key),
                       item.key_where);
    read({item, value.path + "." + item.key}, Vector{length}, target[item.key]);
  }
}

Reader::Reader(const Value& map) : map_(map) { map.map(); }

const Tree* Reader::take(const char* key, bool is_required) {
  known_.emplace_back(key);
  const Tree* tree = map_.tree.find(key);
  if (tree == nullptr && is_required) missing_.emplace_back(key);
  return tree;
}

const Tree* Reader::take_alternative(const char* key) {
  choices_.back().keys.emplace_back(key);
  const Tree* tree = take(key);
  if (tree != nullptr) choices_.back().chosen.emplace_back(key);
  return tree;
}

/// Key of older scenes and the key that replaces it.
struct Renamed {
  std::string_view key, now;
};
constexpr std::array<Renamed, 3> renamed_keys{{
    {"integration.retry", "integration.on_failure"},
    {"integration.implicit.unfinished", "integration.on_failure: {halvings, unsolved}"},
    {"integration.implicit.contact_solves",
     "nothing in its place: contact is solved with the elements"},
}};

void Reader::unknown(const Tree& entry) const {
  const std::string section = map_.path.empty() ? "" : map_.path + ": ";
  const std::string homes = homes_of(entry.key);
  if (map_.path.starts_with("body.regions.") && entry.key == "material")
    throw InputError(section +
                         "unknown key 'material'; a region has the parameters of "
                         "body.material's law without it, such as young_modulus",
                     entry.key_where);
  if (!homes.empty())
    throw InputError(fmt::format("{}unknown key '{}'; it belongs in {}", section, entry.key, homes),
                     entry.key_where);
  const auto renamed = std::ranges::find(renamed_keys, map_.path + "." + entry.key, &Renamed::key);
  if (renamed != renamed_keys.end())
    throw InputError(
        fmt::format("{}unknown key '{}'; expected {}", section, entry.key, renamed->now),
        entry.key_where);
  throw InputError(section + unknown_name("key", entry.key, known_), entry.key_where);
}

void Reader::finish() const {
  for (const Tree& entry : map_.tree.items)
    if (std::ranges::find(known_, entry.key) == known_.end()) unknown(entry);
  const std::string section = map_.path.empty() ? "" : map_.path + ": ";
  if (!missing_.empty())
    throw InputError(fmt::format("{}the key '{}' is missing", section, missing_.front()),
                     map_.tree.key_where);
  for (const Alternatives& choice : choices_) {
    if (choice.chosen.size() == 1 || (choice.chosen.empty() && !choice.required)) continue;
    throw InputError(fmt::format("{}expected {} of {}, got {}", section,
                                 choice.chosen.empty() ? "one" : "only one",
                                 fmt::join(choice.keys, ", "), map_.tree.to_text()),
                     map_.tree.key_where);
  }
}

}  // namespace plica::app
