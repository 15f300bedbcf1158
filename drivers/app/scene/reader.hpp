// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <any>
#include <array>
#include <plica/drivers/app/scene/describe.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Value to be read and its path in the scene.
struct Value {
  const Tree& tree;
  std::string path;

  /// Throws InputError: the value is not what was expected.
  [[noreturn]] void mismatch(const std::string& expected, const std::string& remark = {}) const;
  /// Throws InputError with the path and the location of the value.
  [[noreturn]] void error(const std::string& message) const;
  /// Returns the text of a scalar. Throws InputError for another value.
  const std::string& scalar(const std::string& expected) const;
  /// Returns the items of a list of this size; 0: any size. Throws InputError for another value.
  const std::vector<Tree>& list(const std::string& expected, std::size_t size = 0) const;
  /// Returns the entries of a map. Throws InputError for another value.
  const std::vector<Tree>& map() const;
  /// Returns an item of a list.
  Value item(std::size_t index) const;
};

/// Reads a value of a kind into `target`. Throws InputError with location, value and what is
/// expected. A new kind needs one more overload here, and an overload of schema_of() in
/// key_list.cpp.
void read(const Value& value, const Quantity& kind, double& target);
void read(const Value& value, const AutoQuantity& kind, std::optional<double>& target);
void read(const Value& value, const Vector& kind, Point& target);
void read(const Value& value, const Direction& kind, Point& target);
void read(const Value& value, const NormalOrDirection& kind, Point& target);
void read(const Value& value, const Count& kind, int& target);
void read(const Value& value, const AutoCount& kind, int& target);
void read(const Value& value, const Counts& kind, std::array<int, 3>& target);
void read(const Value& value, const Flag& kind, bool& target);
void read(const Value& value, const Text& kind, std::string& target);
void read(const Value& value, const Name& kind, std::string& target);
void read(const Value& value, const TissueName& kind, MaterialOptions& target);
void read(const Value& value, const PresetName& kind, Problem& target);
void read(const Value& value, const Shares& kind, const Shares::Target& target);
void read(const Value& value, const Entry& kind, Entry::Map& target);
void read(const Value& value, const Every& kind, Interval& target);
void read(const Value& value, const LevelChoice& kind, VolumeLevels& target);
void read(const Value& value, const NamedPoints& kind, std::map<std::string, Point>& target);

template <class Kind, class T>
void read(const Value& value, const ListOf<Kind>& kind, std::vector<T>& target) {
  const bool one = value.tree.kind == Tree::Kind::scalar;
  target.resize(one ? 1 : value.list(kind.type_text()).size());
  if (target.empty()) value.mismatch(kind.type_text());
  for (std::size_t i = 0; i < target.size(); ++i)
    read(one ? value : value.item(i), kind.kind, target[i]);
}

/// Visitor of the table of one struct that fills it from one map of the scene. It is strict: a key
/// that the table does not name, or a required key that is missing, is an error with its location.
class Reader {
 public:
  explicit Reader(const Value& map);

  template <class T, class Kind>
  void operator()(const char* key, T&& member, const Kind& kind, const char*) {
    fill(take(key), kind, member);
  }
  template <class T, class Kind>
  void required(const char* key, T&& member, const Kind& kind, const char*) {
    fill(take(key, true), kind, member);
  }
  void one_of() { choices_.push_back({true, {}, {}}); }
  void at_most_one() { choices_.push_back({false, {}, {}}); }
  template <class T, class Kind>
  void alternative(const char* key, T&& member, const Kind& kind, const char*) {
    fill(take_alternative(key), kind, member);
  }

  /// Throws InputError for unknown keys, missing keys, and none or several of the alternatives. To
  /// be called after the visit of the table.
  void finish() const;

 private:
  const Tree* take(const char* key, bool is_required = false);
  const Tree* take_alternative(const char* key);
  [[noreturn]] void unknown(const Tree& entry) const;
  template <class Kind, class T>
  void fill(const Tree* tree, const Kind& kind, T& member) const {
    if (tree == nullptr) return;
    const std::string path = map_.path.empty() ? tree->key : map_.path + "." + tree->key;
    read(Value{*tree, path}, kind, made(kind, member));
  }

  struct Alternatives {
    bool required;
    std::vector<std::string> keys, chosen;
  };
  Value map_;
  std::vector<std::string> known_, missing_;
  std::vector<Alternatives> choices_;
};

template <class T>
void read(const Value& value, const Group&, T& target) {
  Reader reader(value);
  describe(reader, target);
  reader.finish();
}
template <class T>
void read(const Value& value, const Switch&, std::optional<T>& target) {
  if (value.tree.kind != Tree::Kind::scalar) return read(value, Group{}, target.emplace());
  bool on = false;
  read(value, Flag{}, on);
  target = on ? std::optional<T>(T{}) : std::nullopt;
}
inline void read(const Value& value, const PartOrSelection&, std::optional<LevelCover>& target) {
  LevelCover& cover = target.emplace();
  if (value.tree.kind == Tree::Kind::map) return read(value, Group{}, cover.where.emplace());
  if (value.tree.kind != Tree::Kind::scalar || value.tree.text != "part")
    value.mismatch("part, or a map such as {sphere: {centre: [0, 0, 0], radius: 1 cm}}");
}
template <class T>
void read(const Value& value, const List& kind, std::vector<T>& target) {
  const std::size_t size = value.list("a list").size();
  target.clear();  // a tissue or preset may have filled it
  for (std::size_t i = 0; i < size; ++i) read(value.item(i), Group{}, target.emplace_back());
  if (size < kind.least) value.mismatch("at least one entry");
}
template <class T>
void read(const Value& value, const ListOrMap&, T& target) {
  if (value.tree.kind == Tree::Kind::map) return read(value, Group{}, target.map.emplace());
  read(value, List{1}, target.list);
}
template <class T>
void read(const Value& value, const Map&, std::map<std::string, T>& target) {
  for (const Tree& item : value.map())
    read(Value{item, value.path + "." + item.key}, Group{}, target[item.key]);
}
template <class T>
void read(const Value& value, const BodyMap&, std::map<std::string, T>& target) {
  read(value, Map{}, target);
  if (target.empty()) value.mismatch("at least one body");
}

/// Reads and checks the value of an option of the command line like a value of a scene.
template <class Kind, class Target>
void read_option(const std::string& option, const std::string& text, const Kind& kind,
                 Target& target) {
  const Tree tree{Tree::Kind::scalar, text, {}, {}, {}, {}};
  read({tree, option}, kind, target);
}

/// Returns the option of the command line for a key: "--young-modulus" for "young_modulus".
inline std::string option_of(std::string key) {
  std::ranges::replace(key, '_', '-');
  return "--" + key;
}

/// Fills a struct from options of the command line with the names of its keys.
template <class T>
void read_options(const std::map<std::string, std::string>& given, T& options) {
  for_each_key(options, [&](const char* key, auto& member, const auto& kind, const char*) {
    if constexpr (requires { kind.type_text(); })
      if (const auto text = given.find(key); text != given.end())
        read_option(option_of(key), text->second, kind, made(kind, member));
  });
}

/// Calls add(option, key, allowed values, meaning) for each key of a struct.
template <class T, class Add>
void list_options(T& options, const Add& add) {
  for_each_key(options, [&](const char* key, auto& member, const auto& kind, const char* help) {
    if constexpr (requires { kind.type_text(); }) {
      std::string type_text = kind.type_text();
      if constexpr (requires { kind.to_text(member); })
        type_text += "; default " + kind.to_text(member);
      add(option_of(key), std::string(key), type_text, std::string(help));
    }
  });
}

}  // namespace plica::app
