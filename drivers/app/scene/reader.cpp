// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <plica/drivers/app/scene/key_list.hpp>
#include <plica/drivers/app/scene/reader.hpp>

namespace plica::app {

namespace {

// Where a misplaced key would be right: "body.material or body.regions.<name>"; empty where that says too little
std::string homes_of(const std::string& key) {
  std::vector<std::string> homes;
  for (const KeyInfo& info : scene_keys()) {
    if (info.path == key) homes.emplace_back("the top level");
    if (info.path.ends_with("." + key)) homes.push_back(info.path.substr(0, info.path.size() - key.size() - 1));
  }
  return homes.size() > 2 ? std::string{} : fmt::format("{}", fmt::join(homes, " or "));
}

}  // namespace

Reader::Reader(const Value& map) : map_(map) { check_map(map); }

void Reader::check_map(const Value& value) {
  if (value.tree.kind != Tree::Kind::map) value.mismatch("a map of keys");
}

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

void Reader::unknown(const Tree& entry) const {
  const std::string section = map_.path.empty() ? "" : map_.path + ": ";
  const std::string homes = homes_of(entry.key);
  if (!homes.empty())
    throw InputError(fmt::format("{}unknown key '{}'; it belongs in {}", section, entry.key, homes), entry.key_where);
  throw InputError(section + unknown_name("key", entry.key, known_), entry.key_where);
}

void Reader::finish() const {
  for (const Tree& entry : map_.tree.items)
    if (std::ranges::find(known_, entry.key) == known_.end()) unknown(entry);
  const std::string section = map_.path.empty() ? "" : map_.path + ": ";
  if (!missing_.empty())
    throw InputError(fmt::format("{}the key '{}' is missing", section, missing_.front()), map_.tree.key_where);
  for (const Alternatives& choice : choices_) {
    if (choice.chosen.size() == 1 || (choice.chosen.empty() && !choice.required)) continue;
    throw InputError(fmt::format("{}expected {} of {}, got {}", section, choice.chosen.empty() ? "one" : "only one",
                                 fmt::join(choice.keys, ", "), map_.tree.shown()),
                     map_.tree.key_where);
  }
}

}  // namespace plica::app
