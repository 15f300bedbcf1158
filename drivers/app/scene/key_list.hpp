// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// One key of a scene as `plica list keys` prints it. Lists stand as "levels[]", names of one's own
/// as "<name>".
struct KeyInfo {
  std::string path;
  std::string expects;
  /// what holds when it is left out: "required", "one of these" or the default
  std::string otherwise;
  std::string help;
};

/// Every key, in the order of the tables.
const std::vector<KeyInfo>& scene_keys();

/// What a scene may say as JSON Schema (draft 7, which editors know best), from the tables that
/// read it. It is a little more lenient than the reader: a quantity's unit may be one unit, or one
/// times a power of another.
const nlohmann::ordered_json& scene_schema();

}  // namespace plica::app
