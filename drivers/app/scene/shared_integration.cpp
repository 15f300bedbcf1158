// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/shared_integration.hpp>

namespace plica::app {

namespace {

/// Walks a table and notes each key's path and value.
class KeyValues {
 public:
  using All = std::vector<std::pair<std::string, std::string>>;
  KeyValues(All& all, std::string path) : all_(all), path_(std::move(path)) {}

  template <class T, class Kind>
  void operator()(const char* key, T&& member, const Kind& kind, const char*) {
    const std::string path = path_ + "." + key;
    if constexpr (requires { kind.shown(member); }) {
      std::string value = kind.shown(member);
      if constexpr (std::is_same_v<Kind, Shares>)
        for (const double share : member.shares) value += fmt::format(" {:g}", share);
      all_.emplace_back(path, value);
    } else {
      KeyValues deeper(all_, path);
      describe(deeper, member);
    }
  }

 private:
  All& all_;
  std::string path_;
};

/// Values of the map `above` take the place of those of `below`, key by key.
void put_over(Tree& below, const Tree& above) {
  for (const Tree& item : above.items) {
    const auto same = std::ranges::find(below.items, item.key, &Tree::key);
    if (same == below.items.end())
      below.items.push_back(item);
    else if (same->kind == Tree::Kind::map && item.kind == Tree::Kind::map)
      put_over(*same, item);
    else
      *same = item;
  }
}

/// The scene with this integration over its own, and with bodies that have none.
Tree with_integration(Tree tree, const Tree& integration) {
  for (Tree& body : std::ranges::find(tree.items, "bodies", &Tree::key)->items)
    std::erase_if(body.items, [](const Tree& item) { return item.key == "integration"; });
  const auto given = std::ranges::find(tree.items, "integration", &Tree::key);
  if (given == tree.items.end())
    tree.items.push_back(integration);
  else if (given->kind == Tree::Kind::map)
    put_over(*given, integration);
  else
    *given = integration;
  return tree;
}

KeyValues::All integration_values(const Tree& tree) {
  IntegrationOptions options = read_scene(tree).problem.integration;
  KeyValues::All all;
  KeyValues walk(all, "integration");
  describe(walk, options);
  return all;
}

}  // namespace

Tree shared_integration(const Tree& tree) {
  const Tree* all = tree.find("bodies");
  std::vector<const Tree*> bodies;
  if (all != nullptr)
    for (const Tree& body : all->items)
      if (body.find("integration") != nullptr) bodies.push_back(&body);
  if (bodies.empty()) return tree;
  read_scene(tree);  // each by itself is as it should be
  Tree shared = with_integration(tree, *bodies.front()->find("integration"));
  const KeyValues::All first = integration_values(shared);
  for (const Tree* body : bodies) {
    const KeyValues::All here = integration_values(with_integration(tree, *body->find("integration")));
    const auto [one, other] = std::ranges::mismatch(here, first);
    if (one == here.end()) continue;
    const std::string path = fmt::format("bodies.{}.{}", body->key, one->first);
    throw InputError(
        fmt::format("{} is {}, but bodies.{}.{} is {}; expected the same: bodies are stepped together, since "
                    "they may touch",
                    path, one->second, bodies.front()->key, other->first, other->second),
        place_of(tree, path));
  }
  return shared;
}

}  // namespace plica::app
