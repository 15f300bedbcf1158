// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/key_list.hpp>
#include <plica/drivers/app/scene/units.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// JSON Schema of each kind of value

constexpr const char* magnitude = "([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)?\\s*";

Json any_of(std::initializer_list<Json> choices) { return {{"anyOf", Json(choices)}}; }
Json list_of(const Json& item) { return {{"type", "array"}, {"items", item}, {"minItems", 1}}; }
Json triple_of(const Json& item) {
  return {{"type", "array"}, {"items", item}, {"minItems", 3}, {"maxItems", 3}};
}

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

Json schema_of(const AutoQuantity& kind) {
  return any_of({{{"const", "auto"}}, schema_of(kind.quantity)});
}
Json schema_of(const Vector& kind) {
  return triple_of(schema_of(Quantity{kind.dimension, kind.range}));
}
Json schema_of(const Direction&) { return schema_of(Vector{plain}); }
Json schema_of(const NormalOrDirection&) {
  return any_of({{{"const", "normal"}}, schema_of(Direction{})});
}
Json schema_of(const Count& kind) {
  Json count = {{"type", "integer"}, {"minimum", kind.min}};
  if (kind.max < std::numeric_limits<int>::max()) count["maximum"] = kind.max;
  return count;
}
Json schema_of(const AutoCount& kind) {
  return any_of({{{"const", "auto"}}, schema_of(Count{kind.min, kind.max})});
}
Json schema_of(const Counts& kind) { return triple_of(schema_of(Count{kind.min})); }
Json schema_of(const Flag&) { return {{"type", "boolean"}}; }
Json schema_of(const Text&) {
  return {{"type", {"string", "number", "boolean"}}, {"minLength", 1}};
}
Json schema_of(const Name& kind) { return {{"enum", names(kind.choices())}}; }
template <auto Member>
Json schema_of(const NameOfAll<Member>& kind) {
  return schema_of(kind.name);
}

Json schema_of(const Entry& kind) { return schema_of(kind.quantity); }

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
  return any_of({schema_of(kind.name), list_of(schema_of(Shares::share))});
}

template <class Kind>
Json schema_of(const ListOf<Kind>& kind) {
  const Json one = schema_of(kind.kind);
  return any_of({one, list_of(one)});
}

// Visitor of the tables with default values. Adds every key to a list, and makes the JSON Schema
class Catalogue {
 public:
  Catalogue(std::vector<KeyInfo>& keys, std::string path) : keys_(keys), path_(std::move(path)) {}

  template <class T, class Kind>
  void operator()(const char* key, T&& member, const Kind& kind, const char* help) {
    std::string standard;
    if constexpr (requires { kind.to_text(*held(kind, member)); })
      if (auto* value = held(kind, member)) standard = kind.to_text(*value);
    add(key, member, kind, help, standard, standard.empty() ? "" : "; default " + standard);
  }
  template <class T, class Kind>
  void required(const char* key, T&& member, const Kind& kind, const char* help) {
    required_.push_back(key);
    add(key, member, kind, help, "required");
  }
  void one_of() { choices_.push_back({"one of these", Json::array()}); }
  void at_most_one() { choices_.push_back({"at most one of these", Json::array()}); }
  template <class T, class Kind>
  void alternative(const char* key, T&& member, const Kind& kind, const char* help) {
    choices_.back().keys.push_back({{"required", {key}}});
    add(key, member, kind, help, choices_.back().words);
  }

  Json schema() const {
    Json object = {
        {"type", "object"}, {"properties", properties_}, {"additionalProperties", false}};
    if (!required_.empty()) object["required"] = required_;
    for (const Alternatives& choice : choices_) {
      Json cases = choice.keys;
      if (choice.words != "one of these") cases.push_back({{"not", {{"anyOf", choice.keys}}}});
      object["allOf"].push_back({{"oneOf", cases}});
    }
    return object;
  }

 private:
  template <class T, class Kind>
  void add(const char* key, T& member, const Kind& kind, const std::string& help,
           const std::string& otherwise, const std::string& standard = {}) {
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if constexpr (requires { kind.type_text(); }) {
      keys_.push_back({path, kind.type_text(), otherwise, help});
      properties_[key] = schema_of(kind);
      properties_[key]["description"] = help + "\n" + kind.type_text() + standard;
    } else {
      keys_.push_back({path, kind.words, otherwise, help});
      properties_[key] = inside(member, kind, path);
      properties_[key]["description"] = help;
    }
  }

  // Returns the schema of a key that has keys below it
  template <class T>
  Json object(T& member, const std::string& path) {
    Catalogue deeper(keys_, path);
    describe(deeper, member);
    return deeper.schema();
  }
  template <class T>
  Json object(const std::string& path) {
    T member{};
    return object(member, path);
  }
  template <class T>
  Json inside(T& member, const Group& kind, const std::string& path) {
    using Value = std::remove_reference_t<decltype(made(kind, member))>;
    if constexpr (std::is_same_v<T, Value>)
      return object(member, path);
    else
      return object<Value>(path);
  }
  template <class T>
  Json inside(std::optional<T>&, const Switch&, const std::string& path) {
    Json schema = object<T>(path);  // rules for keys apply to objects only
    schema["type"] = {"boolean", "object"};
    return schema;
  }
  template <class T>
  Json inside(T&, const PartOrSelection&, const std::string& path) {
    return any_of({{{"const", "part"}}, object<Selection>(path)});
  }
  template <class T>
  Json inside(T& member, const List& kind, const std::string& path) {
    using Values = std::remove_reference_t<decltype(made(kind, member))>;
    Json schema = list_of(object<typename Values::value_type>(path + "[]"));
    if (kind.least == 0) schema.erase("minItems");
    return schema;
  }
  template <class T>
  Json inside(T& member, const ListOrMap&, const std::string& path) {
    // rules for items apply to lists only, rules for keys to objects only
    Json schema = inside(member.list, List{}, path);
    schema.update(inside(member.map, Group{}, path));
    schema["type"] = {"array", "object"}, schema["minItems"] = 1;
    return schema;
  }
  template <class T>
  Json inside(std::map<std::string, T>&, const Map&, const std::string& path) {
    return {{"type", "object"}, {"additionalProperties", object<T>(path + ".<name>")}};
  }
  template <class T>
  Json inside(T&, const BodyMap&, const std::string& path) {
    keys_.push_back(
        {path + ".<name>.integration", "a map, as integration", "", body_integration_help});
    Json body = properties_.at("body");
    body["properties"]["integration"] = {{"$ref", "#/properties/integration"},
                                         {"description", body_integration_help}};
    return {{"type", "object"}, {"minProperties", 1}, {"additionalProperties", body}};
  }

  struct Alternatives {
    std::string words;
    Json keys;
  };
  std::vector<KeyInfo>& keys_;
  std::string path_;
  Json properties_ = Json::object(), required_ = Json::array();
  std::vector<Alternatives> choices_;
};

struct All {
  std::vector<KeyInfo> keys;
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "a scene of Plica"}};
};

const All& all() {
  static const All made = [] {
    All result;
    Catalogue catalogue(result.keys, {});
    Scene scene;
    describe(catalogue, scene);
    result.schema.update(catalogue.schema());
    return result;
  }();
  return made;
}

}  // namespace

const std::vector<KeyInfo>& scene_keys() { return all().keys; }
const Json& scene_schema() { return all().schema; }

}  // namespace plica::app
