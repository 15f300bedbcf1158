// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <plica/core/error.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica::app {

/// Scene as a tree of values, each with its location in the file. The meaning of the keys is not
/// known here.
struct Tree {
  /// Type of a value.
  enum class Kind { nothing, scalar, list, map };
  Kind kind = Kind::nothing;
  std::string text;            ///< text of a scalar
  std::vector<Tree> items;     ///< items of a list, or values of a map, in the order of the file
  std::string key;             ///< key of this value in a map; empty: an item of a list
  SourceLocation where;        ///< location of the value
  SourceLocation key_where;    ///< location of the key; for an item of a list, of the value
  std::string older_key = {};  ///< older name of the key, as the file has it; empty: none

  /// Returns the value of a key; null: there is none, or this is no map.
  const Tree* find(std::string_view name) const;

  /// Returns a text for messages: "'4 cm'", "a list of 3", "a map (box, cells)", "nothing".
  std::string to_text() const;
};

/// Reads a YAML file. Throws InputError if it cannot be read, is not YAML, is empty, or holds
/// several documents or a key twice.
Tree read_tree(const std::filesystem::path& file);

/// Reads YAML text; `file` is for messages. Throws InputError like read_tree().
Tree parse_tree(const std::string& text, const std::string& file);

/// Sets or replaces a value: "body.material.young_modulus=30 kPa" or
/// "body.levels.0.box.cells=[4, 4, 4]". Makes a missing key; throws InputError for a missing entry
/// of a list. `label` is the location in messages.
void override_value(Tree& root, const std::string& assignment, const std::string& label);

/// Returns the location of a path such as "integration.macro_step". If the file has no such key,
/// the location is that of the nearest key above it.
SourceLocation place_of(const Tree& root, std::string_view path);

/// Returns a scene as JSON, with its values as texts. Locations are lost.
nlohmann::ordered_json json_of(const Tree& tree);
/// Returns the scene that json_of() has written. All locations are `file`, without lines.
Tree tree_of(const nlohmann::ordered_json& json, const std::string& file);

/// Returns where two scenes first differ: "body.material.density: '1000' became '900'". Empty: they
/// are equal; the order of keys does not matter. The key `but_for` of the top level is ignored.
std::string first_difference(const Tree& before, const Tree& now, const std::string& but_for = {});

}  // namespace plica::app
