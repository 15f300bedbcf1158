// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/schema.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// Walks the same tables as the reader, with defaults for values
class SchemaWriter {
 public:
  template <class T, class Kind>
  void operator()(const char* key, T&& member, const Kind& kind, const char* help) {
    std::string otherwise;
    if constexpr (requires { kind.shown(member); })
      otherwise = kind.shown(member);
    else if (member)
      otherwise = kind.shown(*member);
    add(key, schema_of(kind), said(help, kind) + (otherwise.empty() ? "" : "; default " + otherwise));
  }
  template <class T, class Kind>
  void required(const char* key, T&&, const Kind& kind, const char* help) {
    add(key, schema_of(kind), said(help, kind));
    required_.push_back(key);
  }
  template <class T>
  void group(const char* key, T& member, const char* help) {
    add(key, object_of(member), help);
  }
  template <class T>
  void group(const char* key, std::optional<T>&, const char* help) {
    add(key, object_of<T>(), help);
  }
  template <class T>
  void required_group(const char* key, T& member, const char* help) {
    add(key, object_of(member), help);
    required_.push_back(key);
  }
  template <class T>
  void list(const char* key, std::vector<T>&, const char* help) {
    add(key, list_of<T>(), help);
  }
  template <class T>
  void required_list(const char* key, std::vector<T>& member, const char* help) {
    list(key, member, help);
    required_.push_back(key);
  }
  template <class T>
  void map(const char* key, std::map<std::string, T>&, const char* help) {
    add(key, {{"type", "object"}, {"additionalProperties", object_of<T>()}}, help);
  }
  void one_of() { choices_.push_back({true, Json::array()}); }
  void at_most_one() { choices_.push_back({false, Json::array()}); }
  template <class Target, class T>
  void alternative(const char* key, Target&, T alternative, const char* help) {
    add(key, object_of(alternative), help);
    choose(key);
  }
  template <class T, class Kind>
  void alternative_value(const char* key, T&, const Kind& kind, const char* help) {
    add(key, schema_of(kind), said(help, kind));
    choose(key);
  }

  template <class Target, class T, class Item>
  void alternative_list(const char* key, Target&, const T&, std::vector<Item> T::*, const char* help) {
    add(key, list_of<Item>(), help);
    choose(key);
  }

  Json result() const {
    Json object = {{"type", "object"}, {"properties", properties_}, {"additionalProperties", false}};
    if (!required_.empty()) object["required"] = required_;
    for (const auto& [required, keys] : choices_) {
      Json cases = keys;
      if (!required) cases.push_back({{"not", {{"anyOf", keys}}}});
      object["allOf"].push_back({{"oneOf", cases}});
    }
    return object;
  }

 private:
  template <class Kind>
  static std::string said(const char* help, const Kind& kind) {
    return std::string(help) + "\n" + kind.expects();
  }
  void add(const char* key, Json schema, const std::string& description) {
    schema["description"] = description;
    properties_[key] = std::move(schema);
  }
  void choose(const char* key) { choices_.back().second.push_back({{"required", {key}}}); }
  template <class Item>
  static Json list_of() {
    return {{"type", "array"}, {"items", object_of<Item>()}, {"minItems", 1}};
  }
  template <class T>
  static Json object_of(T& member) {
    SchemaWriter deeper;
    describe(deeper, member);
    return deeper.result();
  }
  template <class T>
  static Json object_of() {
    T member{};
    return object_of(member);
  }

  Json properties_ = Json::object(), required_ = Json::array();
  std::vector<std::pair<bool, Json>> choices_;  // whether one of them must be given
};

}  // namespace

Json scene_schema() {
  SchemaWriter writer;
  Scene scene;
  describe(writer, scene);
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "a scene of Plica"}};
  schema.update(writer.result());
  return schema;
}

}  // namespace plica::app
