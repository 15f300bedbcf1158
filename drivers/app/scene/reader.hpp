// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <plica/drivers/app/scene/describe.hpp>

namespace plica::app {

/// Walks the table of one struct and fills it from one map of the scene. Strict: whatever the table does not name, or
/// the map lacks, is an error with its place.
class Reader {
 public:
  explicit Reader(const Value& map);

  template <class T, class Kind>
  void operator()(const char* key, T&& member, const Kind& kind, const char*) {
    if (const Tree* tree = take(key)) read(kind, at(*tree), member);
  }
  template <class T, class Kind>
  void required(const char* key, T&& member, const Kind& kind, const char*) {
    if (const Tree* tree = take(key, true)) read(kind, at(*tree), member);
  }
  template <class T>
  void group(const char* key, T& member, const char*) {
    if (const Tree* tree = take(key)) read_struct(at(*tree), member);
  }
  template <class T>
  void group(const char* key, std::optional<T>& member, const char*) {
    if (const Tree* tree = take(key)) read_struct(at(*tree), member.emplace());
  }
  template <class T>
  void required_group(const char* key, T& member, const char*) {
    if (const Tree* tree = take(key, true)) read_struct(at(*tree), member);
  }
  template <class T>
  void list(const char* key, std::vector<T>& member, const char*) {
    if (const Tree* tree = take(key)) read_list(at(*tree), member);
  }
  template <class T>
  void required_list(const char* key, std::vector<T>& member, const char*) {
    if (const Tree* tree = take(key, true)) read_list(at(*tree), member);
  }
  template <class T>
  void map(const char* key, std::map<std::string, T>& member, const char*) {
    const Tree* tree = take(key);
    if (tree == nullptr) return;
    check_map(at(*tree));
    for (const Tree& item : tree->items) read_struct({item, at(*tree).path + "." + item.key}, member[item.key]);
  }
  /// The alternatives that follow, up to the next call: exactly one of them is given, or at most one.
  void one_of() { choices_.push_back({true, {}, {}}); }
  void at_most_one() { choices_.push_back({false, {}, {}}); }

  /// `target` takes the alternative as read: a variant or an optional.
  template <class Target, class T>
  void alternative(const char* key, Target& target, T alternative, const char*) {
    if (const Tree* tree = take_alternative(key)) {
      read_struct(at(*tree), alternative);
      target = alternative;
    }
  }
  template <class T, class Kind>
  void alternative_value(const char* key, T& member, const Kind& kind, const char*) {
    if (const Tree* tree = take_alternative(key)) read(kind, at(*tree), member);
  }

  /// An alternative that is a list, in its member `items`.
  template <class Target, class T, class Item>
  void alternative_list(const char* key, Target& target, T alternative, std::vector<Item> T::*items, const char*) {
    if (const Tree* tree = take_alternative(key)) {
      read_list(at(*tree), alternative.*items);
      target = alternative;
    }
  }

  /// After the table: unknown keys, missing ones, none or several of the alternatives.
  void finish() const;

 private:
  static void check_map(const Value& value);
  const Tree* take(const char* key, bool is_required = false);
  const Tree* take_alternative(const char* key);
  Value at(const Tree& tree) const { return {tree, map_.path.empty() ? tree.key : map_.path + "." + tree.key}; }
  [[noreturn]] void unknown(const Tree& entry) const;

  template <class Kind, class T>
  static void read(const Kind& kind, const Value& value, T& member) {
    if constexpr (requires { kind.read(value, member); })
      kind.read(value, member);
    else
      kind.read(value, member.emplace());
  }
  template <class T>
  static void read_struct(const Value& value, T& member) {
    Reader reader(value);
    describe(reader, member);
    reader.finish();
  }
  template <class T>
  static void read_list(const Value& value, std::vector<T>& member) {
    const std::size_t size = value.list("a list").size();
    if (size == 0) value.mismatch("at least one entry");
    for (std::size_t i = 0; i < size; ++i) read_struct(value.item(i), member.emplace_back());
  }

  struct Alternatives {
    bool required;
    std::vector<std::string> keys, chosen;
  };
  Value map_;
  std::vector<std::string> known_, missing_;
  std::vector<Alternatives> choices_;
};

}  // namespace plica::app
