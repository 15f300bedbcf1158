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
Json schema_of(const TissueName& kind) { return schema_of(kind.name); }
Json schema_of(const PresetName& kind) { return schema_of(kind.name); }

Json schema_of(const NamePerLevel& kind) {
  const Json one = schema_of(kind.name);
  return any_of({one, list_of(one)});
}

Json schema_of(const AutoCountPerLevel&) {
  const Json one = schema_of(AutoCount{});
  return any_of({one, list_of(one)});
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

template <auto Member, class Kind>
Json schema_of(const As<Member, Kind>& as) {
  return schema_of(as.kind);
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
    add(key, member, kind, help, default_of(kind, member));
  }
  template <class T, class Kind>
  void required(const char* key, T&& member, const Kind& kind, const char* help) {
    required_.push_back(key);
    add(key, member, kind, help, "required");
  }
  void one_of() { choices_.push_back({"one of these", Json::array()}); }
  void at_most_one() { choices_.push_back({"at most one of these", Json::array()}); }
  template <class T, class Kind>
  void alternative(const char* key, T& target, const Kind& kind, const char* help) {
    choices_.back().keys.push_back({{"required", {key}}});
    add(key, target, kind, help, choices_.back().words);
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
  template <class Kind, class T>
  static std::string default_of(const Kind& kind, T& member) {
    if constexpr (requires { kind.to_text(member); })
      return kind.to_text(member);
    else if constexpr (requires { kind.to_text(*member); })
      return member ? kind.to_text(*member) : "";
    else
      return "";
  }

  template <class T, class Kind>
  void add(const char* key, T& member, const Kind& kind, const std::string& help,
           const std::string& otherwise) {
    const std::size_t place = keys_.size();
    keys_.push_back({path_.empty() ? key : path_ + "." + key, {}, otherwise, help});
    std::string description = help;
    if constexpr (requires { kind.type_text(); }) {
      const std::string standard = default_of(kind, member);
      properties_[key] = schema_of(kind);
      keys_[place].type_text = kind.type_text();
      description += "\n" + kind.type_text() +
                     (otherwise != standard || standard.empty() ? "" : "; default " + standard);
    } else {
      keys_[place].type_text = words_of(kind);
      properties_[key] = inside(member, kind, std::string(keys_[place].path));
    }
    properties_[key]["description"] = description;
  }

  static const char* words_of(const Group&) { return "a map"; }
  static const char* words_of(const Switch&) { return "true, false, or a map"; }
  static const char* words_of(const List&) { return "a list of maps"; }
  static const char* words_of(const ListOrMap&) { return "a list of maps, or a map"; }
  static const char* words_of(const Map&) { return "a map of maps"; }
  static const char* words_of(const BodyMap&) {
    return "a map of maps, each as body, and with integration";
  }
  template <class T>
  static const char* words_of(const Case<T>&) {
    return "a map";
  }
  template <auto Member>
  static const char* words_of(const CaseList<Member>&) {
    return "a list of maps";
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
  template <class Item>
  Json list(const std::string& path) {
    return list_of(object<Item>(path + "[]"));
  }
  template <class T>
  Json inside(T& member, const Group&, const std::string& path) {
    return object(member, path);
  }
  template <class T>
  Json inside(std::optional<T>&, const Group&, const std::string& path) {
    return object<T>(path);
  }
  template <class T>
  Json inside(std::optional<T>&, const Switch&, const std::string& path) {
    Json schema = object<T>(path);  // rules for keys apply to objects only
    schema["type"] = {"boolean", "object"};
    return schema;
  }
  template <class T>
  Json inside(std::vector<T>&, const List&, const std::string& path) {
    Json schema = list<T>(path);
    schema.erase("minItems");
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
  template <class Target, class T>
  Json inside(Target&, const Case<T>&, const std::string& path) {
    return object<T>(path);
  }
  template <class Target, auto Member>
  Json inside(Target&, const CaseList<Member>&, const std::string& path) {
    return list<typename CaseList<Member>::Value::value_type>(path);
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
