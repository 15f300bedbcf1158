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
void read(const Value& value, const Count& kind, int& target);
void read(const Value& value, const AutoCount& kind, int& target);
void read(const Value& value, const Counts& kind, std::array<int, 3>& target);
void read(const Value& value, const Flag& kind, bool& target);
void read(const Value& value, const Text& kind, std::string& target);
void read(const Value& value, const Name& kind, std::string& target);
void read(const Value& value, const TissueName& kind, MaterialOptions& target);
void read(const Value& value, const PresetName& kind, Problem& target);
void read(const Value& value, const NamePerLevel& kind, std::vector<std::string>& target);
void read(const Value& value, const AutoCountPerLevel& kind, std::vector<int>& target);
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

template <auto Member, class Kind, class Target>
void read(const Value& value, const As<Member, Kind>& as, Target& target) {
  typename As<Member, Kind>::Type made;
  read(value, as.kind, made.*Member);
  target = std::move(made);
}

/// Reads an optional value, which is given here.
template <class Kind, class T>
requires(!std::is_same_v<Kind, AutoQuantity>) void read(const Value& value, const Kind& kind,
                                                        std::optional<T>& target) {
  read(value, kind, target.emplace());
}

/// Visitor of the table of one struct that fills it from one map of the scene. It is strict: a key
/// that the table does not name, or a required key that is missing, is an error with its location.
class Reader {
 public:
  explicit Reader(const Value& map);

  template <class T, class Kind>
  void operator()(const char* key, T&& member, const Kind& kind, const char*) {
    if (const Tree* tree = take(key)) fill(at(*tree), kind, member);
  }
  template <class T, class Kind>
  void required(const char* key, T&& member, const Kind& kind, const char*) {
    if (const Tree* tree = take(key, true)) fill(at(*tree), kind, member);
  }
  void one_of() { choices_.push_back({true, {}, {}}); }
  void at_most_one() { choices_.push_back({false, {}, {}}); }
  template <class T, class Kind>
  void alternative(const char* key, T& target, const Kind& kind, const char*) {
    if (const Tree* tree = take_alternative(key)) fill(at(*tree), kind, target);
  }

  /// Throws InputError for unknown keys, missing keys, and none or several of the alternatives. To
  /// be called after the visit of the table.
  void finish() const;

 private:
  static void check_map(const Value& value);
  const Tree* take(const char* key, bool is_required = false);
  const Tree* take_alternative(const char* key);
  Value at(const Tree& tree) const {
    return {tree, map_.path.empty() ? tree.key : map_.path + "." + tree.key};
  }
  [[noreturn]] void unknown(const Tree& entry) const;

  template <class Kind, class T>
  static void fill(const Value& value, const Kind& kind, T& member) {
    read(value, kind, member);
  }
  template <class T>
  static void fill(const Value& value, const Group&, T& member) {
    Reader reader(value);
    describe(reader, member);
    reader.finish();
  }
  template <class T>
  static void fill(const Value& value, const Group& kind, std::optional<T>& member) {
    fill(value, kind, member.emplace());
  }
  template <class T>
  static void fill(const Value& value, const Switch&, std::optional<T>& member) {
    if (value.tree.kind != Tree::Kind::scalar) return fill(value, Group{}, member);
    bool on = false;
    read(value, Flag{}, on);
    on ? void(member.emplace()) : member.reset();
  }
  template <class T>
  static void fill(const Value& value, const List&, std::vector<T>& member) {
    const std::size_t size = value.list("a list").size();
    for (std::size_t i = 0; i < size; ++i) fill(value.item(i), Group{}, member.emplace_back());
  }
  template <class T>
  static void fill(const Value& value, const ListOrMap&, T& member) {
    if (value.tree.kind == Tree::Kind::map) return fill(value, Group{}, member.map);
    fill_some(value, member.list);
  }
  template <class T>
  static void fill_some(const Value& value, std::vector<T>& member) {
    fill(value, List{}, member);
    if (member.empty()) value.mismatch("at least one entry");
  }
  template <class T>
  static void fill(const Value& value, const Map&, std::map<std::string, T>& member) {
    check_map(value);
    for (const Tree& item : value.tree.items)
      fill({item, value.path + "." + item.key}, Group{}, member[item.key]);
  }
  template <class T>
  static void fill(const Value& value, const BodyMap&, std::map<std::string, T>& member) {
    fill(value, Map{}, member);
    if (member.empty()) value.mismatch("at least one body");
  }
  template <class T, class Target>
  static void fill(const Value& value, const Case<T>&, Target& target) {
    T made{};
    fill(value, Group{}, made);
    target = std::move(made);
  }
  template <auto Member, class Target>
  static void fill(const Value& value, const CaseList<Member>&, Target& target) {
    typename CaseList<Member>::Type made;
    fill_some(value, made.*Member);
    target = std::move(made);
  }

  struct Alternatives {
    bool required;
    std::vector<std::string> keys, chosen;
  };
  Value map_;
  std::vector<std::string> known_, missing_;
  std::vector<Alternatives> choices_;
};

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

/// Visitor of a table that fills its struct from options of the command line with the same names.
class OptionReader {
 public:
  explicit OptionReader(const std::map<std::string, std::string>& given) : given_(given) {}
  template <class T, class Kind>
  void operator()(const char* key, T& member, const Kind& kind, const char*) const {
    if constexpr (requires { kind.type_text(); })
      if (const auto text = given_.find(key); text != given_.end())
        read_option(option_of(key), text->second, kind, member);
  }

 private:
  const std::map<std::string, std::string>& given_;
};

/// Visitor of a table that calls add(option, key, allowed values, meaning) for each key.
template <class Add>
class OptionList {
 public:
  explicit OptionList(const Add& add) : add_(add) {}
  template <class T, class Kind>
  void operator()(const char* key, const T& member, const Kind& kind, const char* help) const {
    if constexpr (requires { kind.type_text(); }) {
      std::string type_text = kind.type_text();
      if constexpr (requires { kind.to_text(member); })
        type_text += "; default " + kind.to_text(member);
      add_(option_of(key), std::string(key), type_text, std::string(help));
    }
  }

 private:
  const Add& add_;
};

}  // namespace plica::app
