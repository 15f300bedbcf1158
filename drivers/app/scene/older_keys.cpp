// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <plica/drivers/app/scene/older_keys.hpp>
#include <sstream>
#include <string_view>
#include <utility>

namespace plica::app {

namespace {

/// A key by the end of its path, where the keys above it have their present names. "*" is any name,
/// "#" the number of a list's entry.
struct OlderKey {
  std::vector<std::string_view> path;
  std::string_view present;
};

const std::vector<OlderKey>& older_keys() {
  static const std::vector<OlderKey> keys{
      {{"body", "pressure"}, "volumetric_smoothing"},
      {{"bodies", "*", "pressure"}, "volumetric_smoothing"},
      {{"obstacles", "#", "path"}, "curve"},
      {{"prescribed", "#", "path"}, "curve"},
      {{"loads", "#", "course"}, "curve"},
      {{"obstacles", "#", "turn"}, "rotate"},
      {{"obstacles", "#", "rotate", "path"}, "curve"},
      // selections of vertices, elements or points
      {{"fixed", "#", "plane"}, "half_space"},
      {{"prescribed", "#", "plane"}, "half_space"},
      {{"loads", "#", "plane"}, "half_space"},
      {{"parts", "#", "plane"}, "half_space"},
      {{"from", "plane"}, "half_space"},
      {{"to", "plane"}, "half_space"},
      {{"where", "plane"}, "half_space"},
  };
  return keys;
}

using Path = std::vector<std::string>;

bool is_number(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

bool ends_in(const Path& path, const std::vector<std::string_view>& end) {
  return path.size() >= end.size() &&
         std::equal(end.rbegin(), end.rend(), path.rbegin(),
                    [](std::string_view expected, std::string_view word) {
                      return expected == "*" ||
                             (expected == "#" ? is_number(word) : expected == word);
                    });
}

/// The present name of the last key of a path.
std::string present_key(const Path& path) {
  for (const OlderKey& key : older_keys())
    if (ends_in(path, key.path)) return std::string(key.present);
  return path.back();
}

std::string present_path(const std::string& given) {
  Path path;
  std::istringstream keys(given);
  for (std::string key; std::getline(keys, key, '.');) {
    path.push_back(key);
    path.back() = present_key(path);
  }
  return fmt::format("{}", fmt::join(path, "."));
}

void use_present_keys(Tree& tree, Path& path) {
  for (std::size_t i = 0; i < tree.items.size(); ++i) {
    Tree& item = tree.items[i];
    path.push_back(tree.kind == Tree::Kind::list ? std::to_string(i) : item.key);
    const std::string present = present_key(path);
    if (present != path.back()) {
      if (tree.find(present) != nullptr)
        throw InputError(fmt::format("{}: '{}' is an older name of '{}'; expected one of them",
                                     fmt::join(path, "."), item.key, present),
                         item.key_where);
      item.older_key = std::exchange(item.key, present);
      path.back() = present;
    }
    use_present_keys(item, path);
    path.pop_back();
  }
}

void collect(const Tree& tree, std::vector<const Tree*>& first) {
  const auto same = [&](const Tree* other) {
    return other->older_key == tree.older_key && other->key == tree.key;
  };
  if (!tree.older_key.empty() && std::ranges::none_of(first, same)) first.push_back(&tree);
  for (const Tree& item : tree.items) collect(item, first);
}

}  // namespace

void use_present_keys(Tree& scene) {
  Path path;
  use_present_keys(scene, path);
}

void set_value(Tree& scene, const std::string& assignment, const std::string& label) {
  use_present_keys(scene);
  const std::size_t equals = std::min(assignment.find('='), assignment.size());
  override_value(scene, present_path(assignment.substr(0, equals)) + assignment.substr(equals),
                 label);
}

std::vector<std::string> warnings_of_older_keys(const Tree& scene) {
  std::vector<const Tree*> first;
  collect(scene, first);
  std::vector<std::string> warnings;
  for (const Tree* tree : first)
    warnings.push_back(fmt::format("{}:{}: the key '{}' is called '{}'; the older name still works",
                                   tree->key_where.file, tree->key_where.line, tree->older_key,
                                   tree->key));
  return warnings;
}

}  // namespace plica::app
