// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/key_list.hpp>

namespace plica::app {
namespace {

// Walks the same tables as the reader, with defaults for values
class KeyList {
 public:
  KeyList(std::vector<KeyInfo>& keys, std::string path) : keys_(keys), path_(std::move(path)) {}

  template <class T, class Kind>
  void operator()(const char* key, T&& member, const Kind& kind, const char* help) {
    if constexpr (requires { kind.shown(member); })
      add(key, kind.expects(), kind.shown(member), help);
    else
      add(key, kind.expects(), member ? kind.shown(*member) : "", help);
  }
  template <class T, class Kind>
  void required(const char* key, T&&, const Kind& kind, const char* help) {
    add(key, kind.expects(), "required", help);
  }
  template <class T>
  void group(const char* key, T& member, const char* help) {
    add(key, "a map", "", help);
    walk(member, key);
  }
  template <class T>
  void group(const char* key, std::optional<T>&, const char* help) {
    add(key, "a map", "", help);
    walk_new<T>(key);
  }
  template <class T>
  void required_group(const char* key, T& member, const char* help) {
    add(key, "a map", "required", help);
    walk(member, key);
  }
  template <class T>
  void list(const char* key, std::vector<T>&, const char* help) {
    add(key, "a list of maps", "", help);
    walk_new<T>(std::string(key) + "[]");
  }
  template <class T>
  void required_list(const char* key, std::vector<T>&, const char* help) {
    add(key, "a list of maps", "required", help);
    walk_new<T>(std::string(key) + "[]");
  }
  template <class T>
  void map(const char* key, std::map<std::string, T>&, const char* help) {
    add(key, "a map of maps", "", help);
    walk_new<T>(std::string(key) + ".<name>");
  }
  void one_of() { choice_ = "one of these"; }
  void at_most_one() { choice_ = "at most one of these"; }
  template <class Target, class T>
  void alternative(const char* key, Target&, T alternative, const char* help) {
    add(key, "a map", choice_, help);
    walk(alternative, key);
  }
  template <class T, class Kind>
  void alternative_value(const char* key, T&, const Kind& kind, const char* help) {
    add(key, kind.expects(), choice_, help);
  }
  template <class Target, class T, class Item>
  void alternative_list(const char* key, Target&, const T&, std::vector<Item> T::*, const char* help) {
    add(key, "a list of maps", choice_, help);
    walk_new<Item>(std::string(key) + "[]");
  }

 private:
  std::string below(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  void add(const char* key, std::string expects, std::string otherwise, const char* help) {
    keys_.push_back({below(key), std::move(expects), std::move(otherwise), help});
  }
  template <class T>
  void walk(T& member, const std::string& key) {
    KeyList deeper(keys_, below(key));
    describe(deeper, member);
  }
  template <class T>
  void walk_new(const std::string& key) {
    T member{};
    walk(member, key);
  }

  std::vector<KeyInfo>& keys_;
  std::string path_, choice_;
};

}  // namespace

const std::vector<KeyInfo>& scene_keys() {
  static const std::vector<KeyInfo> keys = [] {
    std::vector<KeyInfo> list;
    KeyList visitor(list, {});
    Scene scene;
    describe(visitor, scene);
    return list;
  }();
  return keys;
}

}  // namespace plica::app
