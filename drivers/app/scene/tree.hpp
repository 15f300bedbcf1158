// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <plica/core/error.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica::app {

/// A scene as it stands in the file, every value with its place. Nothing is known here about what
/// the keys mean.
struct Tree {
  enum class Kind { nothing, scalar, list, map };
  Kind kind = Kind::nothing;
  std::string text;            ///< of a scalar
  std::vector<Tree> items;     ///< of a list, or the values of a map, in the order of the file
  std::string key;             ///< under which a map holds it
  Where where;                 ///< of the value
  Where key_where;             ///< of its key; for an entry of a list that of the value
  std::string older_key = {};  ///< the older name of its key that the file has; empty: none

  /// the value of that key, null when there is none
  const Tree* find(std::string_view name) const;

  /// "'4 cm'", "a list of 3", "a map (box, cells)", "nothing": for messages.
  std::string shown() const;
};

/// Reads a YAML file. InputError when it cannot be read, is not YAML, is empty, holds several
/// documents or a key twice.
Tree read_tree(const std::filesystem::path& file);

/// The same from text; `file` is for messages.
Tree parse_tree(const std::string& text, const std::string& file);

/// Puts a value where "body.material.young_modulus=30 kPa" or "body.levels.0.box.cells=[4, 4, 4]"
/// says, replacing what is there. A missing key is made, a missing entry of a list is an error.
/// `label` stands for the place in messages.
void override_value(Tree& root, const std::string& assignment, const std::string& label);

/// Where the value of "integration.macro_step" stands, or the nearest key above it that the file
/// has.
Where place_of(const Tree& root, std::string_view path);

/// A scene as JSON, its values as the words that stand there, and back; places are lost but for the
/// file.
nlohmann::ordered_json json_of(const Tree& tree);
Tree tree_of(const nlohmann::ordered_json& json, const std::string& file);

/// Where two scenes first differ: "body.material.density: '1000' became '900'"; empty where they
/// say the same in whatever order. A key of the top level may be left out of this.
std::string first_difference(const Tree& before, const Tree& now, const std::string& but_for = {});

}  // namespace plica::app
