// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Key of a scene, as `plica list keys` prints it.
struct KeyInfo {
  std::string path;       ///< path of the key; a list is "levels[]", a user's own name "<name>"
  std::string type_text;  ///< allowed values
  /// meaning of a missing key: "required", "one of these" or the default
  std::string otherwise;
  std::string help;  ///< meaning of the key
};

/// Returns every key, in the order of the tables.
const std::vector<KeyInfo>& scene_keys();

/// Returns the JSON Schema of scenes (draft 7, which editors support best), made from the tables
/// that read scenes. It is a little more lenient than the reader. The unit of a quantity is one
/// unit there, or one unit times a power of another.
const nlohmann::ordered_json& scene_schema();

}  // namespace plica::app
