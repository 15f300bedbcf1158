// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/load_bodies.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/run/join_bodies.hpp>

namespace plica::app {

namespace {

using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// Collects the path and the value of each key of a struct.
template <class T>
void collect_values(KeyValues& all, const std::string& path, T& options) {
  for_each_key(options, [&](const char* key, auto& member, const auto& kind, const char*) {
    const std::string inside = path + "." + key;
    if constexpr (requires { kind.to_text(member); }) {
      std::string value = kind.to_text(member);
      if constexpr (requires { member.shares; })
        for (const double share : member.shares) value += fmt::format(" {:g}", share);
      all.emplace_back(inside, value);
    } else {
      collect_values(all, inside, member);
    }
  });
}

/// Replaces values of the map `below` by those of `above`, key by key.
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

/// Returns the scene with this integration put over its own, and with none in its bodies.
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

KeyValues integration_values(const Tree& tree) {
  IntegrationOptions options = read_scene(tree).problem.integration;
  KeyValues all;
  collect_values(all, "integration", options);
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
  read_scene(tree);  // throws if one of them is wrong by itself
  Tree shared = with_integration(tree, *bodies.front()->find("integration"));
  const KeyValues first = integration_values(shared);
  for (const Tree* body : bodies) {
    const KeyValues here = integration_values(with_integration(tree, *body->find("integration")));
    const auto [one, other] = std::ranges::mismatch(here, first);
    if (one == here.end()) continue;
    const std::string path = fmt::format("bodies.{}.{}", body->key, one->first);
    throw InputError(
        fmt::format("{} is {}, but bodies.{}.{} is {}; expected the same: bodies are stepped "
                    "together, since "
                    "they may touch",
                    path, one->second, bodies.front()->key, other->first, other->second),
        place_of(tree, path));
  }
  return shared;
}

namespace {

bool is_space(const Tree& level) { return level.find("coarsen") != nullptr; }
bool covers_all(const Tree& level) {
  return level.find("covers") == nullptr && level.find("refine") == nullptr;
}

/// Returns the scene with one of its bodies as `body`. The body gets `levels` meshes: its coarsest
/// mesh is repeated. Coarse spaces come after the meshes.
Tree scene_of_one(const Tree& tree, const Tree& body, std::size_t levels) {
  Tree one = tree;
  std::erase_if(one.items, [](const Tree& item) {
    return item.key == "bodies" || item.key == "output" || item.key == "attachments";
  });
  one.items.push_back(body);
  one.items.back().key = "body";
  for (Tree& item : one.items.back().items)
    if (item.key == "levels" && item.kind == Tree::Kind::list) {
      const auto first = std::ranges::find_if(item.items, is_space);
      const auto meshes =
          static_cast<std::size_t>(std::count_if(item.items.begin(), first, covers_all));
      if (meshes > 0 && meshes < levels)
        item.items.insert(first, levels - meshes, Tree(*(first - 1)));
    }
  return one;
}

/// Returns a message about `body` with the path that this body has in the scene, "bodies.NAME".
std::string renamed(std::string message, const std::string& name) {
  const std::string from = "body.", to = "bodies." + name + ".";
  for (std::size_t at = 0; (at = message.find(from, at)) != std::string::npos; at += to.size())
    if (at == 0 || message[at - 1] == ' ')  // names of files stay
      message.replace(at, from.size(), to);
  return message;
}

/// Loads the scene of one body. Obstacles, which all of them share, are built with the `first`.
Scene load_one(const Tree& tree, const std::string& name, bool first) {
  try {
    Scene one = read_scene(tree);
    check_scene(one, tree);
    if (!first) one.obstacles.clear();
    build_meshes(one, tree);
    return one;
  } catch (const InputError& error) {
    throw InputError(renamed(error.what(), name));
  }
}

std::vector<int> joined_numbers(std::vector<int> all, std::vector<int> more, std::size_t before,
                                std::size_t count) {
  if (more.empty()) more.resize(count), std::iota(more.begin(), more.end(), 0);
  for (const int number : more) all.push_back(number + static_cast<int>(before));
  return all;
}

/// Appends the numbering of one body on a level: bodies are in sequence, each in its input order.
void add_numbering(Numbering& all, const Numbering& one, const TetMesh& mesh, std::size_t vertices,
                   std::size_t tets) {
  Reordering& input = all.input;
  input.vertices =
      joined_numbers(std::move(input.vertices), one.input.vertices, vertices, mesh.vertices.size());
  input.tets = joined_numbers(std::move(input.tets), one.input.tets, tets, mesh.tets.size());
}

std::size_t meshes_of(const BodyRecipe& body) {
  return static_cast<std::size_t>(std::ranges::count_if(
      body.levels, [](const LevelRecipe& level) { return !level.coarsen && !is_part(level); }));
}

}  // namespace

Scene load_bodies(const Tree& tree) {
  const Scene recipe = read_scene(tree);
  std::size_t levels = 0;
  for (const auto& [name, body] : recipe.bodies)
    levels = std::max({levels, meshes_of(body), body.lattices ? body.lattices->sizes.size() : 0});
  for (const auto& [name, body] : recipe.bodies)
    if (body.lattices && body.lattices->sizes.size() != levels) {
      const std::string path = "bodies." + name + ".levels.sizes";
      throw InputError(path + " are " + std::to_string(body.lattices->sizes.size()) +
                           "; expected " + std::to_string(levels) +
                           ", as many as the other bodies have levels",
                       place_of(tree, path));
    }
  Scene all = recipe;
  all.numbering.assign(levels, {});
  std::vector<std::size_t> vertices(levels, 0), tets(levels, 0);
  std::vector<std::pair<std::string, Body>> bodies;
  for (const Tree& item : tree.find("bodies")->items) {
    Scene one = load_one(scene_of_one(tree, item, levels), item.key, bodies.empty());
    if (count_levels(all.levels) < count_levels(one.levels)) all.levels = one.levels;
    if (!all.surface) all.surface = one.surface;
    for (std::string& warning : one.warnings) all.warnings.push_back(renamed(warning, item.key));
    for (std::size_t i = 0; i < std::min(levels, one.numbering.size()); ++i) {
      const TetMesh& mesh = one.problem.body.levels[i];
      add_numbering(all.numbering[i], one.numbering[i], mesh, vertices[i], tets[i]);
      vertices[i] += mesh.vertices.size(), tets[i] += mesh.tets.size();
    }
    // obstacles of `one` have triangulated surfaces, those of the recipe have none
    if (bodies.empty()) all.problem.contact.obstacles = std::move(one.problem.contact.obstacles);
    bodies.emplace_back(item.key, std::move(one.problem.body));
  }
  try {
    all.problem.body = join_bodies(bodies);
  } catch (const InputError& error) {
    throw located(error, tree);
  }
  for (Numbering& one : all.numbering) {
    const Reordering back = inverse(one.input);
    one.vertex_ids = back.vertices, one.tet_ids = back.tets;
  }
  check_scene(all, tree);
  return all;
}

}  // namespace plica::app
