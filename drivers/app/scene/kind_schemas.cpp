// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/scene/schema.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

constexpr const char* magnitude = "([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)?\\s*";

Json any_of(std::initializer_list<Json> choices) { return {{"anyOf", Json(choices)}}; }
Json list_of(const Json& item) { return {{"type", "array"}, {"items", item}, {"minItems", 1}}; }
Json triple_of(const Json& item) { return {{"type", "array"}, {"items", item}, {"minItems", 3}, {"maxItems", 3}}; }

}  // namespace

Json schema_of(const Quantity& kind) {
  Json plain = {{"type", "number"}};
  if (kind.range.min > -std::numeric_limits<double>::infinity())
    plain[kind.range.min_excluded ? "exclusiveMinimum" : "minimum"] = kind.range.min;
  if (kind.range.max < std::numeric_limits<double>::infinity())
    plain[kind.range.max_excluded ? "exclusiveMaximum" : "maximum"] = kind.range.max;
  const std::string sign = kind.range.min < 0 ? "^\\s*[+-]?" : "^\\s*\\+?";
  const std::string pattern = sign + magnitude + "(" + unit_pattern(kind.dimension) + ")?\\s*$";
  return any_of({plain, {{"type", "string"}, {"pattern", pattern}}});
}

Json schema_of(const AutoQuantity& kind) { return any_of({{{"const", "auto"}}, schema_of(kind.quantity)}); }
Json schema_of(const Vector& kind) { return triple_of(schema_of(Quantity{kind.dimension, kind.range})); }
Json schema_of(const Count& kind) { return {{"type", "integer"}, {"minimum", kind.min}}; }
Json schema_of(const AutoCount&) { return any_of({{{"const", "auto"}}, schema_of(Count{1})}); }
Json schema_of(const Counts& kind) { return triple_of(schema_of(Count{kind.min})); }
Json schema_of(const Flag&) { return {{"type", "boolean"}}; }
Json schema_of(const Text&) { return {{"type", {"string", "number", "boolean"}}, {"minLength", 1}}; }
Json schema_of(const Name& kind) { return {{"enum", names(kind.choices())}}; }

Json schema_of(const NamePerLevel& kind) {
  const Json one = schema_of(kind.name);
  return any_of({one, list_of(one)});
}

Json schema_of(const AutoCountPerLevel&) {
  const Json one = schema_of(AutoCount{});
  return any_of({one, list_of(one)});
}

Json schema_of(const Every&) {
  const Json steps = {{"type", "string"}, {"pattern", "^0*[1-9][0-9]* *steps?$"}};
  return any_of({schema_of(Quantity{duration, positive}), steps});
}

Json schema_of(const LevelChoice&) {
  Json levels = list_of(schema_of(Count{0}));
  levels["uniqueItems"] = true;
  return any_of({{{"type", "boolean"}}, {{"const", "all"}}, levels});
}

Json schema_of(const NamedPoints&) {
  return {{"type", "object"},
          {"minProperties", 1},
          {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
          {"additionalProperties", schema_of(Vector{length})}};
}

Json schema_of(const Shares& kind) {
  return any_of({schema_of(kind.name), list_of(schema_of(Quantity{number, not_negative}))});
}

}  // namespace plica::app
