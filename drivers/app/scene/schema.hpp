// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json.hpp>
#include <plica/drivers/app/scene/kinds.hpp>

namespace plica::app {

/// What a scene may say as JSON Schema (draft 7, which editors know best), from the tables that read it. It is a little more
/// lenient than the reader: a quantity's unit may be one unit, or one times a power of another.
nlohmann::ordered_json scene_schema();

/// What each kind of value may look like. A new kind needs one more.
nlohmann::ordered_json schema_of(const Quantity& kind);
nlohmann::ordered_json schema_of(const AutoQuantity& kind);
nlohmann::ordered_json schema_of(const Vector& kind);
nlohmann::ordered_json schema_of(const Count& kind);
nlohmann::ordered_json schema_of(const Counts& kind);
nlohmann::ordered_json schema_of(const AutoCount& kind);
nlohmann::ordered_json schema_of(const Flag& kind);
nlohmann::ordered_json schema_of(const Text& kind);
nlohmann::ordered_json schema_of(const Name& kind);
nlohmann::ordered_json schema_of(const NamePerLevel& kind);
nlohmann::ordered_json schema_of(const AutoCountPerLevel& kind);
nlohmann::ordered_json schema_of(const Every& kind);
nlohmann::ordered_json schema_of(const LevelChoice& kind);
nlohmann::ordered_json schema_of(const NamedPoints& kind);
nlohmann::ordered_json schema_of(const Shares& kind);
template <class Alternative, class Member, class Kind>
nlohmann::ordered_json schema_of(const As<Alternative, Member, Kind>& kind) {
  return schema_of(kind.kind);
}
template <class Kind>
nlohmann::ordered_json schema_of(const ListOf<Kind>& kind) {
  const nlohmann::ordered_json one = schema_of(kind.kind);
  return {{"anyOf", {one, {{"type", "array"}, {"items", one}, {"minItems", 1}}}}};
}

}  // namespace plica::app
