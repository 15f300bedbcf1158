// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/scene/tree_json.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

Json json_of(const Tree& tree) {
  if (tree.kind == Tree::Kind::scalar) return tree.text;
  if (tree.kind == Tree::Kind::nothing) return nullptr;
  Json json = tree.kind == Tree::Kind::list ? Json::array() : Json::object();
  for (const Tree& item : tree.items) {
    if (tree.kind == Tree::Kind::list)
      json.push_back(json_of(item));
    else
      json[item.key] = json_of(item);
  }
  return json;
}

Tree tree_of(const Json& json, const std::string& file) {
  Tree tree;
  tree.where.file = tree.key_where.file = file;
  if (json.is_string()) {
    tree.kind = Tree::Kind::scalar;
    tree.text = json.get<std::string>();
  } else if (json.is_structured()) {
    tree.kind = json.is_array() ? Tree::Kind::list : Tree::Kind::map;
    for (const auto& [key, value] : json.items()) {
      tree.items.push_back(tree_of(value, file));
      if (json.is_object()) tree.items.back().key = key;
    }
  }
  return tree;
}

namespace {

std::string below(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

std::string difference(const Tree& before, const Tree& now, const std::string& path, const std::string& but_for);

std::string map_difference(const Tree& before, const Tree& now, const std::string& path, const std::string& but_for) {
  for (const Tree& item : before.items) {
    if (item.key == but_for) continue;
    const Tree* other = now.find(item.key);
    if (other == nullptr) return below(path, item.key) + ": " + item.shown() + " is not there any more";
    if (std::string found = difference(item, *other, below(path, item.key), {}); !found.empty()) return found;
  }
  for (const Tree& item : now.items)
    if (item.key != but_for && before.find(item.key) == nullptr) return below(path, item.key) + ": is new";
  return {};
}

std::string difference(const Tree& before, const Tree& now, const std::string& path, const std::string& but_for) {
  if (before.kind != now.kind || before.text != now.text ||
      (before.kind == Tree::Kind::list && before.items.size() != now.items.size()))
    return path + ": " + before.shown() + " became " + now.shown();
  if (before.kind == Tree::Kind::map) return map_difference(before, now, path, but_for);
  for (std::size_t i = 0; i < before.items.size(); ++i)
    if (std::string found = difference(before.items[i], now.items[i], below(path, std::to_string(i)), {});
        !found.empty())
      return found;
  return {};
}

}  // namespace

std::string first_difference(const Tree& before, const Tree& now, const std::string& but_for) {
  return difference(before, now, {}, but_for);
}

}  // namespace plica::app
