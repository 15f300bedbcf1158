// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <fstream>
#include <plica/drivers/app/scene/tree.hpp>
#include <sstream>

namespace plica::app {
namespace {

Where place(const std::string& file, const YAML::Mark& mark) { return {file, mark.is_null() ? 0 : mark.line + 1}; }

Tree converted(const YAML::Node& node, const std::string& file);

void add_entry(Tree& map, const YAML::Node& key, const YAML::Node& value, const std::string& file) {
  const Where where = place(file, key.Mark());
  if (!key.IsScalar()) throw InputError("a key must be a word", where);
  if (const Tree* earlier = map.find(key.Scalar())) {
    throw InputError("the key '" + key.Scalar() + "' stands here for the second time; the first is in line " +
                         std::to_string(earlier->key_where.line),
                     where);
  }
  Tree entry = converted(value, file);
  entry.key = key.Scalar();
  entry.key_where = where;
  if (entry.kind == Tree::Kind::nothing) entry.where = where;
  map.items.push_back(std::move(entry));
}

Tree converted(const YAML::Node& node, const std::string& file) {
  Tree tree;
  tree.where = tree.key_where = place(file, node.Mark());
  if (node.IsScalar()) {
    tree.kind = Tree::Kind::scalar;
    tree.text = node.Scalar();
  } else if (node.IsSequence()) {
    tree.kind = Tree::Kind::list;
    for (const YAML::Node& item : node) tree.items.push_back(converted(item, file));
  } else if (node.IsMap()) {
    tree.kind = Tree::Kind::map;
    for (const auto& entry : node) add_entry(tree, entry.first, entry.second, file);
  }
  return tree;
}

// The value that one part of a path leads to: the key of a map or the number of an entry
Tree& stepped(Tree& tree, const std::string& part, const Where& where) {
  if (tree.kind == Tree::Kind::list) {
    std::size_t index = 0;
    const auto [rest, error] = std::from_chars(part.data(), part.data() + part.size(), index);
    if (error != std::errc{} || rest != part.data() + part.size() || index >= tree.items.size())
      throw InputError("'" + part + "' is no entry of this list, which has " + std::to_string(tree.items.size()) +
                           ", counted from 0",
                       where);
    return tree.items[index];
  }
  if (tree.kind == Tree::Kind::scalar)
    throw InputError("cannot set '" + part + "' inside " + tree.shown() + ", which is a single value", where);
  tree.kind = Tree::Kind::map;
  for (Tree& item : tree.items)
    if (item.key == part) return item;
  Tree& made = tree.items.emplace_back();
  made.key = part;
  made.where = made.key_where = where;
  return made;
}

}  // namespace

const Tree* Tree::find(std::string_view name) const {
  if (kind != Kind::map) return nullptr;
  for (const Tree& item : items)
    if (item.key == name) return &item;
  return nullptr;
}

std::string Tree::shown() const {
  if (kind == Kind::scalar) return "'" + text + "'";
  if (kind == Kind::list) return "a list of " + std::to_string(items.size());
  if (kind == Kind::nothing) return "nothing";
  std::string keys;
  for (const Tree& item : items) keys += (keys.empty() ? "" : ", ") + item.key;
  return keys.empty() ? "an empty map" : "a map (" + keys + ")";
}

Tree parse_tree(const std::string& text, const std::string& file) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty() || documents[0].IsNull()) throw InputError("the scene is empty", {file});
    if (documents.size() > 1)
      throw InputError("a scene is one YAML document; here begins another", place(file, documents[1].Mark()));
    return converted(documents[0], file);
  } catch (const YAML::Exception& error) {
    throw InputError("not YAML: " + error.msg, place(file, error.mark));
  }
}

Tree read_tree(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw InputError(std::filesystem::exists(file) ? "this is not a file" : "there is no such file", {file.string()});
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw InputError("the file cannot be read", {file.string()});
  return parse_tree(text.str(), file.string());
}

void override_value(Tree& root, const std::string& assignment, const std::string& label) {
  const Where where{label, 0};
  const std::size_t equals = assignment.find('=');
  if (equals == 0 || equals == std::string::npos) throw InputError("expected key.path=value", where);
  Tree value;
  try {
    value = converted(YAML::Load(assignment.substr(equals + 1)), where.file);
  } catch (const YAML::Exception& error) {
    throw InputError("not YAML: " + error.msg, where);
  }
  Tree* target = &root;
  std::istringstream path(assignment.substr(0, equals));
  for (std::string part; std::getline(path, part, '.');) target = &stepped(*target, part, where);
  const auto place_all = [&where](Tree& tree, const auto& self) -> void {
    tree.where = tree.key_where = where;  // a line within the argument says nothing
    for (Tree& item : tree.items) self(item, self);
  };
  place_all(value, place_all);
  value.key = target->key;
  *target = std::move(value);
}

Where place_of(const Tree& root, std::string_view path) {
  const Tree* tree = &root;
  std::istringstream parts{std::string(path)};
  for (std::string part; std::getline(parts, part, '.');) {
    const Tree* next = tree->find(part);
    std::size_t index = 0;
    if (tree->kind == Tree::Kind::list &&
        std::from_chars(part.data(), part.data() + part.size(), index).ec == std::errc{} && index < tree->items.size())
      next = &tree->items[index];
    if (next == nullptr) break;
    tree = next;
  }
  return tree->key_where;
}

}  // namespace plica::app
